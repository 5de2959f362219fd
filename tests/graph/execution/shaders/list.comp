void main() {
  if (element_index() > 0u) return;
  counts[0] = 1u;
  counts[1] = 1u;
  counts[2] = 1u;
}
