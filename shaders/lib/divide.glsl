// Software renderers divide integers invocation by invocation; floats they divide eight at a time.

// Quotient in y and remainder in x, of a number from 0 to 2^30 by one from 1. A float's quotient is off by up to number / 2^22 and by one for its rounding;
// dividing what is left once more leaves one.
ivec2 divided(int number, int by) {
  float part = 1.0 / float(by);
  int quotient = int(float(number) * part);
  int left = number - quotient * by;
  int more = int(floor(float(left) * part));
  quotient += more;
  left -= more * by;
  int beyond = left < 0 ? -1 : left >= by ? 1 : 0;
  return ivec2(left - beyond * by, quotient + beyond);
}
