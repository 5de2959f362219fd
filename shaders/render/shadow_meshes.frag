void main() {}  // depth alone
