in vec2 from_center;

void main() {
  if (dot(from_center, from_center) > 1.0) discard;
}
