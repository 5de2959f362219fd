void main() {
  int i = int(element_index());
  if (i < 4) taken[i] = rest_at(i) - 1;
}
