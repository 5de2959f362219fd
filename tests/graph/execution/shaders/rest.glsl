// A number of the type that the buffer `rest` has.
#if KIND_INT
#define REST(number) int(number)
#elif KIND_UINT
#define REST(number) uint(number)
#else
#define REST(number) float(number)
#endif
