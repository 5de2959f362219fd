void main() {
  runs[0] = mistyped;
}
