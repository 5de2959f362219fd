#include <string>

#include "tests/catch.h"
#include "tests/graph/loaded.h"

// Every malformed form, and where the user is sent.

namespace firn::test {
namespace {

Lines step_messages(const std::string& items) { return load_messages("firn: 1\nstep:\n" + items); }

TEST_CASE("a missing file, an empty file and broken YAML are errors") {
  const Folder folder;
  CHECK(loaded(folder, "p.yaml").messages == Lines{"p.yaml: error: there is no such file"});
  folder.write("p.yaml", "");
  CHECK(loaded(folder, "p.yaml").messages == Lines{"p.yaml: error: the file is empty"});
  folder.write("p.yaml", "firn: 1\nstep: [a\n");
  CHECK(loaded(folder, "p.yaml").messages.size() == 1);
}

TEST_CASE("a pipeline is a map that begins with its version") {
  CHECK(load_messages("- a\n- b\n") == Lines{"p.yaml:1:1: error: a pipeline must be a map of 'key: value', not a list"});
  CHECK(load_messages("step: [a]\n") ==
        Lines{"p.yaml:1:1: error: missing key 'firn': a pipeline begins with 'firn: 1', the version of its format"});
  CHECK(load_messages("firn: 2\nstep: [a]\n") == Lines{"p.yaml:1:7: error: firn must be 1, not 2"});
  CHECK(load_messages("firn: one\nstep: [a]\n") == Lines{"p.yaml:1:7: error: firn must be a whole number, not 'one'"});
}

TEST_CASE("an unknown key of a pipeline is an error with the nearest one") {
  CHECK(load_messages("firn: 1\nstep: [a]\nfrmae: [b]\n") ==
        Lines{"p.yaml:3:1: error: a pipeline has no key 'frmae'; did you mean 'frame'?"});
}

TEST_CASE("a pipeline without stages is an error") {
  CHECK(load_messages("firn: 1\nname: nothing\n") ==
        Lines{"p.yaml:1:1: error: the pipeline has no stages: list them under 'setup', 'step' or 'frame'"});
  CHECK(load_messages("firn: 1\nstep: []\n").size() == 1);
}

TEST_CASE("name, doc and scene are texts") {
  CHECK(load_messages("firn: 1\nname: [a]\ndoc: {b: c}\nscene: [d]\nstep: [a]\n") ==
        Lines{"p.yaml:2:7: error: name must be a text, not a list", "p.yaml:3:6: error: doc must be a text, not a map",
              "p.yaml:4:8: error: scene must be a text, not a list"});
}

TEST_CASE("phases are lists of stages") {
  CHECK(load_messages("firn: 1\nsetup: a\nstep: {a: {}}\nframe: 3\n") ==
        Lines{"p.yaml:2:8: error: setup must be a list of stages, not 'a'",
              "p.yaml:3:7: error: step must be a list of stages, not a map",
              "p.yaml:4:8: error: frame must be a list of stages, not '3'"});
}

TEST_CASE("an entry that is no stage is an error with the forms that there are") {
  const std::string forms = "error: expected a stage's name, '- stage: {parameter: value}', a repeat or a group, not ";
  CHECK(step_messages("  - [a]\n  - ~\n  - {}\n") ==
        Lines{"p.yaml:3:5: " + forms + "a list", "p.yaml:4:5: " + forms + "nothing", "p.yaml:5:5: " + forms + "a map"});
}

TEST_CASE("two stages in one entry are an error that shows where options belong") {
  CHECK(step_messages("  - a: {}\n    speed: 3\n") == Lines{"p.yaml:4:5: error: 'speed' beside 'a': one stage per list entry; "
                                                            "options belong in the braces behind its name: '- a: {speed: "
                                                            "...}'"});
}

TEST_CASE("the options of a stage are a map") {
  CHECK(step_messages("  - a: 3\n  - a: [speed]\n") ==
        Lines{"p.yaml:3:8: error: the options of a must be a map such as {parameter: value}, not '3'",
              "p.yaml:4:8: error: the options of a must be a map such as {parameter: value}, not a list"});
  CHECK(step_messages("  - stage: [a]\n") == Lines{"p.yaml:3:12: error: stage must be a text, not a list"});
}

TEST_CASE("options of the wrong kind are errors at their values") {
  CHECK(step_messages("  - a: {every: 0}\n  - a: {every: often}\n  - a: {every: 1.5}\n  - a: {enable: 1}\n  - a: {as: [b]}\n"
                      "  - a: {bind: x}\n  - a: {bind: {x: [y]}}\n") ==
        Lines{"p.yaml:3:16: error: every must be between 1 and 1000000000, not 0",
              "p.yaml:4:16: error: every must be a whole number, not 'often'",
              "p.yaml:5:16: error: every must be a whole number, not '1.5'",
              "p.yaml:6:17: error: enable must be true or false, not '1'; write true or false",
              "p.yaml:7:13: error: as must be a text, not a list",
              "p.yaml:8:15: error: bind must be a map of ports to buffers such as {port: buffer}, not 'x'",
              "p.yaml:9:19: error: the buffer of port x must be a text, not a list"});
}

TEST_CASE("two stages cannot be given one name") {
  CHECK(step_messages("  - a: {as: one}\n  - b: {as: one}\n") == Lines{"p.yaml:4:5: error: two stages are called 'one'"});
  CHECK(step_messages("  - a\n  - b: {as: a}\n") == Lines{"p.yaml:4:5: error: two stages are called 'a'"});
}

TEST_CASE("a repeat that is malformed is an error at what is wrong") {
  CHECK(step_messages("  - repeat: 0\n    stages: [a]\n") ==
        Lines{"p.yaml:3:13: error: repeat must be between 1 and 1000000, not 0"});
  CHECK(step_messages("  - repeat: often\n    stages: [a]\n") ==
        Lines{"p.yaml:3:13: error: repeat must be a whole number, not 'often'"});
  CHECK(step_messages("  - repeat: 3\n") == Lines{"p.yaml:3:5: error: a repeat needs the key 'stages'"});
  CHECK(step_messages("  - repeat: 3\n    stages: a\n") == Lines{"p.yaml:4:13: error: stages must be a list of stages, not 'a'"});
  CHECK(step_messages("  - repeat: {mx: 3}\n    stages: [a]\n") ==
        Lines{"p.yaml:3:13: error: repeat needs the key 'max'", "p.yaml:3:14: error: repeat has no key 'mx'; did you mean 'max'?"});
  CHECK(step_messages("  - repeat: 3\n    stags: [a]\n") ==
        Lines{"p.yaml:3:5: error: a repeat needs the key 'stages'",
              "p.yaml:4:5: error: a repeat has no key 'stags'; did you mean 'stages'?"});
}

TEST_CASE("an until that is malformed is an error at what is wrong") {
  const auto with = [](const std::string& until) {
    return step_messages("  - repeat: {max: 3, until: " + until + "}\n    stages: [a]\n");
  };
  CHECK(with("x") == Lines{"p.yaml:3:29: error: until must be a map of 'key: value', not 'x'"});
  CHECK(with("{buffer: x}") == Lines{"p.yaml:3:29: error: until needs the key 'below'"});
  CHECK(with("{below: 1}") == Lines{"p.yaml:3:29: error: until needs the key 'buffer'"});
  CHECK(with("{buffer: x, below: small}") == Lines{"p.yaml:3:48: error: below must be a number, not 'small'"});
  CHECK(with("{buffer: x, below: 1, abov: 2}") == Lines{"p.yaml:3:51: error: until has no key 'abov'; valid: buffer, below"});
}

TEST_CASE("a group that is malformed is an error at what is wrong") {
  CHECK(step_messages("  - group: g\n") == Lines{"p.yaml:3:5: error: a group needs the key 'stages'"});
  CHECK(step_messages("  - group: [g]\n    stages: [a]\n") == Lines{"p.yaml:3:12: error: group must be a text, not a list"});
  CHECK(step_messages("  - group: g\n    stages: [a]\n    every: 2\n") ==
        Lines{"p.yaml:5:5: error: a group has no key 'every'; valid: group, when, stages"});
}

TEST_CASE("a when that is malformed is an error at what is wrong") {
  const auto with = [](const std::string& when) {
    return load_messages("firn: 1\nparameters: {kernel: cubic}\nstep:\n  - a: {when: " + when + "}\n");
  };
  CHECK(with("{kernl: cubic}") == Lines{"p.yaml:4:16: error: no parameter 'kernl' in this pipeline; did you mean 'kernel'?"});
  CHECK(with("cubic") == Lines{"p.yaml:4:15: error: when must be a map of the pipeline's parameters to values such as {kernel: "
                               "cubic}, not 'cubic'"});
  CHECK(with("{kernel: {is: cubic}}") ==
        Lines{"p.yaml:4:24: error: when compares 'kernel' with a value or a list of values, not with a map"});
  CHECK(step_messages("  - a: {when: {k: 1}}\n") ==
        Lines{"p.yaml:3:16: error: when asks for 'k', but this pipeline has no parameters of its own"});
}

TEST_CASE("replace of what is not there is an error with the nearest group") {
  CHECK(load_messages("firn: 1\nreplace: {displac: [a]}\nstep: [{group: displace, stages: [b]}]\n") ==
        Lines{"p.yaml:2:11: error: no group 'displac' to replace; did you mean 'displace'?"});
  CHECK(load_messages("firn: 1\nreplace: [a]\nstep: [b]\n") ==
        Lines{"p.yaml:2:10: error: replace must be a map of groups to lists of stages, not a list"});
  CHECK(load_messages("firn: 1\nreplace: {g: a}\nstep: [{group: g, stages: [b]}]\n") ==
        Lines{"p.yaml:2:14: error: stages must be a list of stages, not 'a'"});
}

TEST_CASE("an unknown parameter is an error at its use, with the nearest one") {
  CHECK(load_messages("firn: 1\nparameters: {speed: 8}\nstep:\n  - a: {k: \"${sped}\"}\n") ==
        Lines{"p.yaml:4:12: error: unknown parameter 'sped'; did you mean 'speed'?"});
  CHECK(load_messages("firn: 1\nstep:\n  - a: {k: \"${k}\"}\n") ==
        Lines{"p.yaml:3:12: error: unknown parameter 'k'; there are no parameters"});
  CHECK(load_messages("firn: 1\nparameters: [k]\nstep: [a]\n") ==
        Lines{"p.yaml:2:13: error: parameters must be a map of names to values, not a list"});
}

TEST_CASE("all errors of a file are found in one pass") {
  CHECK(load_messages("firn: 1\nnmae: x\nsetup: a\nstep:\n  - a: {every: 0}\n  - repeat: 0\n    stages: [[]]\n").size() == 5);
}

}  // namespace
}  // namespace firn::test
