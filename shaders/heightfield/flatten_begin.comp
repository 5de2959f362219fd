// Nothing has moved yet.
void main() {
  if (element_index() > 0u) return;
  moved_bits[0] = 0u;
  moved[0] = 0.0;
}
