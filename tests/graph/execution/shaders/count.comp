// Counts how often it runs, and halves what is left.
void main() {
  if (element_index() > 0u) return;
  runs[0] += 1.0;
  left[0] *= 0.5;
}
