// Nothing noted and nothing added yet.
void main() {
  uint body = element_index();
  if (body >= bodies_count) return;
  for (uint slot = 0u; slot < 4u; ++slot) {
    SUM_PEAKS[4u * body + slot] = 0u;
    SUM_COUNTS[4u * body + slot] = 0u;
    SUM_WORDS[8u * body + 2u * slot] = 0u;
    SUM_WORDS[8u * body + 2u * slot + 1u] = 0u;
  }
}
