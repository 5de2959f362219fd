// Nothing moves yet.
void main() {
  if (element_index() == 0u) fastest[0] = 0u;
}
