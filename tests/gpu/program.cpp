#include "gpu/program.h"

#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;
namespace fs = std::filesystem;

namespace {

const char* const head = "layout(local_size_x = 1) in;\n";

ShaderSource assembled(const fs::path& file, const std::vector<fs::path>& folders) {
  ShaderSource source;
  append_file(source, file, folders);
  return source;
}

std::string compile_error(const Device& device, const fs::path& file, const std::vector<fs::path>& folders) {
  ShaderSource source{device.version_directive() + "\n", {}};
  append_file(source, file, folders);
  const std::array shaders = {std::pair{ShaderKind::compute, source}};
  return message_of<ShaderError>([&] { Program(shaders, "broken"); });
}

}  // namespace

TEST_CASE("a compile error is told at the file and line of the user, before, in and after an include") {
  const auto device = Device::open();
  const TemporaryFolder folder;
  const std::string good = "float twice(float x) {\n  return 2.0 * x;\n}\n";
  const std::string broken = "float twice(float x) {\n  return 2.0 * undeclared_name;\n}\n";

  SECTION("in the included file") {
    const fs::path library = folder.write("lib/twice.glsl", broken);
    const fs::path main = folder.write("main.comp", std::string(head) + "#include \"lib/twice.glsl\"\nvoid main() {}\n");
    const std::string message = compile_error(*device, main, {});
    contains(message, "'broken'");
    contains(message, library.string() + ":2: error: ");
    contains(message, "undeclared_name");
  }
  SECTION("after the include") {
    folder.write("lib/twice.glsl", good);
    const fs::path main =
        folder.write("main.comp", std::string(head) + "#include \"lib/twice.glsl\"\nvoid main() {\n  nonsense;\n}\n");
    contains(compile_error(*device, main, {}), main.string() + ":4: error: ");
  }
  SECTION("before the include") {
    folder.write("lib/twice.glsl", good);
    const fs::path main =
        folder.write("main.comp", std::string(head) + "int a = nonsense;\n\n#include \"lib/twice.glsl\"\nvoid main() {}\n");
    contains(compile_error(*device, main, {}), main.string() + ":2: error: ");
  }
  SECTION("by the preprocessor") {
    const fs::path main = folder.write("main.comp", std::string(head) + "\n#error this is wrong\nvoid main() {}\n");
    const std::string message = compile_error(*device, main, {});
    contains(message, main.string() + ":3: error: ");
    contains(message, "this is wrong");
  }
  CHECK_NOTHROW(device->check());
}

TEST_CASE("generated text after a file counts its lines in the whole text") {
  const auto device = Device::open();
  const TemporaryFolder folder;
  ShaderSource source{device->version_directive() + "\n" + head, {}};
  append_file(source, folder.write("a.glsl", "float a() { return 1.0; }"), {});
  source.text += "void main() {\n  nonsense;\n}\n";
  // 1 #version, 2 layout, 3 #line, 4 a(), 5 #line, 6 main, 7 the error
  const std::array shaders = {std::pair{ShaderKind::compute, source}};
  contains(message_of<ShaderError>([&] { Program(shaders, "broken"); }), "generated:7: error: ");
}

TEST_CASE("errors of all shaders of a program are told at once") {
  const auto device = Device::open();
  const std::array shaders = {std::pair{ShaderKind::vertex, with_version(*device, "void main() { first_error; }")},
                              std::pair{ShaderKind::fragment, with_version(*device, "void main() { second_error; }")}};
  const std::string message = message_of<ShaderError>([&] { Program(shaders, "broken"); });
  contains(message, "first_error");
  contains(message, "second_error");
}

TEST_CASE("what does not link is an error with the program's name") {
  const auto device = Device::open();
  const std::array shaders = {
      std::pair{ShaderKind::compute, with_version(*device, std::string(head) + "void later(); void main() { later(); }")}};
  contains(message_of<ShaderError>([&] { Program(shaders, "half a kernel"); }), "'half a kernel' does not link:\n");
  CHECK_NOTHROW(device->check());
}

TEST_CASE("includes are found beside the including file first, then in the folders in their order") {
  const TemporaryFolder folder;
  folder.write("first/value.glsl", "int first;\n");
  folder.write("second/value.glsl", "int second;\n");
  const fs::path main = folder.write("here/main.comp", "#include \"value.glsl\"\n");
  const std::vector<fs::path> folders = {folder.path() / "first", folder.path() / "second"};
  contains(assembled(main, folders).text, "int first;");
  folder.write("here/value.glsl", "int beside;\n");
  contains(assembled(main, folders).text, "int beside;");
}

TEST_CASE("a file is included once, and a cycle of includes ends") {
  const TemporaryFolder folder;
  folder.write("a.glsl", "#include \"b.glsl\"\nint a;\n");
  folder.write("b.glsl", "#include \"sub/../a.glsl\"\nint b;\n");
  folder.write("sub/c.glsl", "int c;\n");
  const fs::path main = folder.write(
      "main.comp", "#include \"a.glsl\"\n#include \"b.glsl\"\n  # include \"a.glsl\"  // again\n#include \"main.comp\"\n");
  const ShaderSource source = assembled(main, {});
  CHECK(source.files == std::vector<std::string>{"generated", main.string(), (folder.path() / "a.glsl").string(),
                                                 (folder.path() / "b.glsl").string()});
  const auto count = [&](const std::string& part) {
    int found = 0;
    for (std::size_t at = source.text.find(part); at != std::string::npos; at = source.text.find(part, at + 1)) ++found;
    return found;
  };
  CHECK(count("int a;") == 1);
  CHECK(count("int b;") == 1);
  CHECK(count("#include") == 0);
}

TEST_CASE("every switch of file is marked by a #line directive") {
  const TemporaryFolder folder;
  folder.write("b.glsl", "int b;");
  const fs::path main = folder.write("main.comp", "int a;\r\n#include \"b.glsl\"\r\nint c;\r\n");
  ShaderSource source{"int generated;", {}};
  append_file(source, main, {});
  CHECK(source.text == "int generated;\n#line 1 1\nint a;\n#line 1 2\nint b;\n#line 3 1\nint c;\n#line 9 0\n");
}

TEST_CASE("a missing include is named with its place and the folders searched") {
  const TemporaryFolder folder;
  folder.write("lib/a.glsl", "int a;\n#include \"nowhere.glsl\"\n");
  const fs::path main = folder.write("main.comp", "#include \"a.glsl\"\n");
  const std::vector<fs::path> folders = {folder.path() / "lib", folder.path() / "other"};
  const std::string message = message_of<ShaderError>([&] { assembled(main, folders); });
  contains(message, (folder.path() / "lib/a.glsl").string() + ":2: error: ");
  contains(message, "'nowhere.glsl'");
  contains(message, (folder.path() / "other").string());
}

TEST_CASE("a file that cannot be read and an include without quotes are errors") {
  const TemporaryFolder folder;
  contains(message_of<ShaderError>([&] { assembled(folder.path() / "none.comp", {}); }), "none.comp: error: ");
  const fs::path main = folder.write("main.comp", "int a;\n#include <a.glsl>\n");
  contains(message_of<ShaderError>([&] { assembled(main, {}); }), main.string() + ":2: error: ");
}

TEST_CASE("an include within a comment is none") {
  const TemporaryFolder folder;
  const fs::path main = folder.write("main.comp", R"(
// #include "none.glsl"
/* as in
#include "none.glsl"
*/ int a; // /* does not open
int b;
/* #include "none.glsl" */
)");
  contains(assembled(main, {}).text, "int b;");
}

TEST_CASE("a comment that crosses the line of an include is an error") {
  const TemporaryFolder folder;
  folder.write("a.glsl", "int a;\n");
  const std::string text = GENERATE("#include \"a.glsl\" /* a\n*/\n", "/*\n*/ #include \"a.glsl\"\n");
  const fs::path main = folder.write("main.comp", text);
  contains(message_of<ShaderError>([&] { assembled(main, {}); }), ": error: a comment over several lines");
}

TEST_CASE("a #line directive in the user's own file does not move messages") {
  const auto device = Device::open();
  const TemporaryFolder folder;
  const fs::path main =
      folder.write("main.comp", std::string(head) + "  #line 100 7\n/*\n#line 30\n*/\nvoid main() { nonsense; }\n");
  contains(compile_error(*device, main, {}), main.string() + ":6: error: ");
}

TEST_CASE("messages of every driver are mapped to file and line") {
  const ShaderSource source{"", {"generated", "shaders/a.comp", "shaders/lib/b.glsl"}};
  SECTION("Mesa") {
    CHECK(mapped_log("1:12(3): error: `x' undeclared\n2:7(11): warning: `y' used uninitialized\n", source) ==
          "shaders/a.comp:12: error: `x' undeclared\nshaders/lib/b.glsl:7: warning: `y' used uninitialized");
    CHECK(mapped_log("0:3(2): preprocessor error: #error no\n", source) == "generated:3: error: #error no");
  }
  SECTION("NVIDIA") {
    CHECK(mapped_log(
              "2(12) : error C1503: undefined variable \"x\"\n1(4) : warning C7050: \"y\" might be used before being initialized\n",
              source) ==
          "shaders/lib/b.glsl:12: error: C1503: undefined variable \"x\"\n"
          "shaders/a.comp:4: warning: C7050: \"y\" might be used before being initialized");
  }
  SECTION("Intel and AMD") {
    CHECK(mapped_log("ERROR: 1:12: 'x' : undeclared identifier\nWARNING: 0:1: extension\n", source) ==
          "shaders/a.comp:12: error: 'x' : undeclared identifier\ngenerated:1: warning: extension");
  }
  SECTION("positions in source 0 are lines of the whole text") {
    const ShaderSource whole{"#version 450\n#line 1 1\na\n#line 1 2\nb\n#line 3 1\nc\n#line 9 0\ngenerated", source.files};
    CHECK(mapped_log("0:1(1): error: x\n0:3(1): error: x\n0(5) : error x\nERROR: 0:7: x\n0:8(1): error: x\n0:9(1): error: x\n",
                     whole) ==
          "generated:1: error: x\nshaders/a.comp:1: error: x\nshaders/lib/b.glsl:1: error: x\nshaders/a.comp:3: error: x\n"
          "shaders/a.comp:4: error: x\ngenerated:9: error: x");
  }
  SECTION("what is none of them, or names a source that there is not, stays as it is; empty lines go") {
    CHECK(mapped_log("error: linking with uncompiled shader\r\n\n9:1(1): error: x\n99999999999999999999(1) : error C1: y",
                     source) == "error: linking with uncompiled shader\n9:1(1): error: x\n99999999999999999999(1) : error C1: y");
    CHECK(mapped_log("", source).empty());
    CHECK(mapped_log(std::string_view("1:2(3): error: x\n\0", 18), source) == "shaders/a.comp:2: error: x");
  }
}
