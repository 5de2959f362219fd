#pragma once

// What is wrong with the user's files, and where. Input errors are collected and shown together.

#include <stdexcept>
#include <string>
#include <vector>

namespace firn::config {

// A place in a text the user wrote. Lines and columns count from 1; 0 means the file as a whole.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

enum class Severity { warning, error };

struct Diagnostic {
  Severity severity = Severity::error;
  Place place;
  std::string text;
};

// "file:line:column: error: text"; line and column are left out where the place is a whole file.
std::string to_string(const Place& place);
std::string to_string(const Diagnostic& diagnostic);

class Diagnostics {
 public:
  void error(Place place, std::string text);
  void warning(Place place, std::string text);
  void append(const Diagnostics& other);

  [[nodiscard]] bool has_errors() const;
  [[nodiscard]] const std::vector<Diagnostic>& all() const { return list_; }

 private:
  std::vector<Diagnostic> list_;
};

// Thrown once, with everything that was found. what() holds one line per diagnostic.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Diagnostics diagnostics);
  [[nodiscard]] const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  Diagnostics diagnostics_;
};

void throw_if_errors(const Diagnostics& diagnostics);

}  // namespace firn::config
