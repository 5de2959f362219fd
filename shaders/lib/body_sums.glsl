// Sums over the cells of each body that have the same bits in whatever order they are added: whole numbers of steps, in two words. The size
// of a step follows from the largest addend and the number of addends, which a pass before must have noted; so nothing can overflow, and
// at least 31 bits of each addend count for up to 65536 of them.
// Before including: SUM_PEAKS, SUM_COUNTS and SUM_WORDS name the buffers; four sums (slots 0..3) per body. lib/column_sums.glsl fills them.

// The power of two that a value is divided by so that its size is at most 1.
float sum_unit(int at) {
  int exponent;
  frexp(uintBitsToFloat(SUM_PEAKS[at]), exponent);
  return ldexp(1.0, exponent);
}
// Of 2^bits addends, each may have 31 - bits bits in the upper word and 32 - bits in the lower one.
int spare_bits(int at) { return findMSB(max(SUM_COUNTS[at], 1u)) + 1; }

#if !defined(NOTING) && !defined(ADDING)
float total(int body, int slot) {
  int at = 4 * body + slot;
  if (SUM_PEAKS[at] == 0u) return 0.0;
  int bits = spare_bits(at);
  // The lower word in units of the upper one may be far above 1: its whole part goes over first, so that no bit is lost but the last.
  uint lower = SUM_WORDS[2 * at + 1];
  int upper = int(SUM_WORDS[2 * at]) + int(lower >> uint(32 - bits));
  uint rest = lower & ((1u << uint(32 - bits)) - 1u);
  return (ldexp(float(upper), bits - 31) + ldexp(float(rest), 2 * bits - 63)) * sum_unit(at);
}
#endif
