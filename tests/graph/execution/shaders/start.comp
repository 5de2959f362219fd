void main() {
  if (element_index() == 0u) left[0] = 1.0;
}
