// Two of the values are not finite.
void main() {
  uint i = element_index();
  if (i < 2u && step == 3u) fault(FAULT_NOT_A_NUMBER);
}
