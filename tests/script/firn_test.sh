#!/usr/bin/env bash
# Tests of the script ./firn. Each case gets a small checkout of its own, in a folder with a space in its name, and a PATH on which
# cmake, apt-get, dpkg-query and sudo are stand-ins that write down what they were asked.
#
#   firn_test.sh             all cases
#   firn_test.sh CASE        one
set -euo pipefail

source_root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox='' # of the running case
status=0   # of the last ./firn

write_program() {
  printf '#!/usr/bin/env bash\n%s\n' "$2" >"$1"
  chmod +x "$1"
}

set_up() {
  sandbox=$(mktemp -d)
  tree="$sandbox/the tree"
  mkdir -p "$tree/cmake" "$sandbox/bin" "$sandbox/log"
  cp "$source_root/firn" "$tree/firn"
  printf '# comment\n\nbuild    alpha   why\nbuild    beta\ncheck    gamma\n' >"$tree/cmake/packages.txt"
  printf 'alpha\nbeta\n' >"$sandbox/installed"
  local tool
  for tool in bash cat chmod dirname env flock grep ls mkdir nproc readlink rm sed sleep tail tee touch; do
    ln -s "$(command -v "$tool")" "$sandbox/bin/$tool"
  done
  export SANDBOX=$sandbox
  # Configuring leaves a cache, building a program that prints its words, one a line, and exits with $EXIT.
  # shellcheck disable=SC2016
  write_program "$sandbox/bin/cmake" '
printf "%s\n" "$*" >>"$SANDBOX/log/cmake"
if [[ $1 == --build ]]; then
  echo "[1/1] Linking"
  if [[ -e $SANDBOX/build-fails ]]; then echo "FAILED: thing.o"; echo "thing.cpp:3: error: no such thing"; exit 1; fi
  printf "#!/usr/bin/env bash\nprintf \"%%s\\\\n\" \"\$@\"\nls -l /proc/self/fd >\"\$SANDBOX/log/descriptors\"\nexit \${EXIT:-0}\n" >"$2/firn"
  chmod +x "$2/firn"
else
  sleep 0.2
  if [[ -e $SANDBOX/configure-fails ]]; then echo "CMake Error: no such package"; exit 1; fi
  mkdir -p "$4"; touch "$4/CMakeCache.txt"
fi'
  # shellcheck disable=SC2016
  write_program "$sandbox/bin/dpkg-query" '
echo "$*" >>"$SANDBOX/log/dpkg-query"
while read -r name state; do printf "%s %s \n" "$name" "${state:-ii}"; done <"$SANDBOX/installed"'
  # shellcheck disable=SC2016
  write_program "$sandbox/bin/apt-get" '
echo "$*" >>"$SANDBOX/log/apt-get"
while [[ $1 == -* ]]; do [[ $1 == -o ]] && shift; shift; done
if [[ -e $SANDBOX/no-network ]]; then echo "E: could not resolve the mirror"; exit 100; fi
if [[ $1 == update ]]; then rm -f "$SANDBOX/old-lists"; exit 0; fi
if [[ -e $SANDBOX/old-lists ]]; then echo "E: unable to locate package"; exit 100; fi
shift
for name; do [[ $name == -* ]] || echo "$name" >>"$SANDBOX/installed"; done'
  # shellcheck disable=SC2016
  write_program "$sandbox/bin/sudo" 'echo "$*" >>"$SANDBOX/log/sudo"; exec "$@"'
}

# run WORDS...: ./firn with these words; its outputs go to $sandbox/stdout and stderr, its exit status to $status.
run() {
  status=0
  env PATH="$sandbox/bin" "${prefix[@]}" "${firn:-$tree/firn}" "$@" >"$sandbox/stdout" 2>"$sandbox/stderr" </dev/null || status=$?
}

fail() {
  printf 'FAILED: %s\n--- standard output\n%s\n--- standard error\n%s\n' "$*" "$(<"$sandbox/stdout")" "$(<"$sandbox/stderr")" >&2
  exit 1
}
expect_status() { ((status == $1)) || fail "the exit status is $status, not $1"; }
expect_stdout() { [[ $(<"$sandbox/stdout") == "$1" ]] || fail "standard output is not: $1"; }
expect_stderr() { [[ $(<"$sandbox/stderr") == *"$1"* ]] || fail "standard error does not say: $1"; }
expect_silence() { [[ ! -s $sandbox/stderr ]] || fail "standard error is not empty"; }
expect_lines() {
  local count
  count=$(grep -c -e "$2" "$sandbox/log/$1" 2>/dev/null) || true
  ((${count:-0} == $3)) || fail "$1 was called ${count:-0} times, not $3, with: $2"
}

# --- Cases

case_words_and_exit_status_are_kept() {
  EXIT=4 run run 'a b' '' '*' "it's"
  expect_status 4
  expect_stdout $'run\na b\n\n*\nit\'s'
}

case_any_folder_and_a_symbolic_link_will_do() {
  mkdir "$sandbox/elsewhere"
  ln -s "../the tree/firn" "$sandbox/elsewhere/link"
  cd "$sandbox/elsewhere"
  firn=./link run check here.yaml
  expect_status 0
  expect_stdout $'check\nhere.yaml'
  [[ -x $tree/build/firn && ! -e $sandbox/elsewhere/build ]] || fail "built in the wrong place"
}

case_a_second_start_says_nothing_and_looks_for_nothing() {
  run list
  expect_stderr 'configuring'
  run list
  expect_status 0
  expect_silence
  expect_lines dpkg-query alpha 1
  expect_lines cmake '^-S' 1
  expect_lines cmake '^--build' 2
}

case_only_the_verb_test_builds_the_tests() {
  run run test
  expect_lines cmake '--target firn$' 1
  run test
  expect_lines cmake '--target all$' 1
  run --verbose test
  expect_lines cmake '--target all$' 2
}

case_missing_packages_are_named_then_installed() {
  echo alpha >"$sandbox/installed"
  run list
  expect_status 0
  expect_stderr 'installing 1 packages with apt-get: beta'
  expect_lines apt-get 'install -y --no-install-recommends beta$' 1
  expect_stdout list
}

case_a_removed_package_that_left_its_settings_is_missing() {
  printf 'alpha hi\nbeta rc\n' >"$sandbox/installed"
  run list
  expect_status 0
  expect_stderr 'installing 1 packages with apt-get: beta'
}

case_installing_can_be_refused() {
  : >"$sandbox/installed"
  FIRN_NO_INSTALL=1 run list
  expect_status 1
  expect_stderr 'missing: alpha beta'
  expect_lines apt-get . 0
  expect_stdout ''
  FIRN_NO_INSTALL=0 run list
  expect_status 0
}

case_old_package_lists_are_fetched_anew() {
  : >"$sandbox/installed"
  touch "$sandbox/old-lists"
  run list
  expect_status 0
  expect_lines apt-get update 1
}

case_without_a_network_the_packages_to_install_are_told() {
  : >"$sandbox/installed"
  touch "$sandbox/no-network"
  run list
  expect_status 1
  expect_stderr 'could not resolve the mirror'
  expect_stderr 'By hand: apt-get update && apt-get install --no-install-recommends alpha beta'
  expect_stdout ''
  rm "$sandbox/no-network"
  run list
  expect_status 0
}

case_a_package_that_does_not_arrive_is_an_error() {
  : >"$sandbox/installed"
  write_program "$sandbox/bin/apt-get" 'exit 0'
  run list
  expect_status 1
  expect_stderr 'still missing after the installation: alpha beta'
}

case_a_user_installs_with_sudo() {
  become_user
  : >"$sandbox/installed"
  run list
  expect_status 0
  expect_lines sudo 'apt-get .*install' 1
}

case_a_user_without_sudo_is_told_what_to_install() {
  become_user
  rm "$sandbox/bin/sudo"
  : >"$sandbox/installed"
  run list
  expect_status 1
  expect_stderr 'As root: apt-get install --no-install-recommends alpha beta'
}

case_the_check_tools_are_for_developers() {
  FIRN_DEVELOP=1 run list
  expect_status 0
  expect_lines apt-get 'install .*gamma$' 1
}

case_another_system_is_told_the_names_and_goes_on() {
  rm "$sandbox/bin/dpkg-query" "$sandbox/bin/apt-get"
  run list
  expect_status 0
  expect_stderr 'alpha beta'
  expect_stdout list
}

case_a_changed_package_list_is_looked_at() {
  run list
  echo 'build    delta' >>"$tree/cmake/packages.txt"
  run list
  expect_lines apt-get 'install .*delta$' 1
}

case_a_failing_configuration_is_shown_and_tried_again() {
  touch "$sandbox/configure-fails"
  run list
  expect_status 1
  expect_stderr 'CMake Error: no such package'
  expect_stdout ''
  rm "$sandbox/configure-fails"
  run list
  expect_status 0
}

case_a_failing_build_is_shown_and_nothing_runs() {
  run list
  touch "$sandbox/build-fails"
  run list
  expect_status 1
  expect_stderr 'thing.cpp:3: error: no such thing'
  expect_stderr 'the build failed'
  expect_stdout ''
}

case_a_moved_checkout_is_configured_anew() {
  run list
  mv "$tree" "$sandbox/moved"
  tree="$sandbox/moved"
  run list
  expect_status 0
  expect_lines cmake "^-S $sandbox/moved" 1
}

case_other_options_are_configured_anew() {
  run list
  FIRN_CMAKE_ARGS='-DA=1 -DB=2' run list
  expect_lines cmake ' -G Ninja -DA=1 -DB=2$' 1
  run list
  expect_lines cmake ' -G Ninja$' 2
}

case_the_build_folder_and_type_can_be_chosen() {
  FIRN_BUILD_TYPE=Debug run list
  expect_lines cmake "-B $tree/build-debug -DCMAKE_BUILD_TYPE=Debug" 1
  cd "$sandbox"
  FIRN_BUILD='of mine' run list
  expect_lines cmake "-B $sandbox/of mine -DCMAKE_BUILD_TYPE=Release" 1
}

case_preparing_can_stop_early() {
  FIRN_STOP_AFTER=packages run list
  expect_lines cmake . 0
  FIRN_STOP_AFTER=configure run list
  expect_lines cmake '^--build' 0
  FIRN_STOP_AFTER=build run list
  expect_status 0
  expect_stdout ''
  FIRN_STOP_AFTER=bilud run list
  expect_status 1
  expect_stderr 'bilud'
}

case_several_at_once_prepare_once() {
  local i pids=()
  for i in 1 2 3 4; do
    env PATH="$sandbox/bin" "$tree/firn" number "$i" >"$sandbox/stdout" 2>"$sandbox/stderr" &
    pids+=($!)
  done
  for i in "${pids[@]}"; do wait "$i" || fail "one of several failed"; done
  expect_lines cmake '^-S' 1
  expect_lines dpkg-query alpha 1
}

case_the_program_does_not_hold_the_lock() {
  run list
  ! grep -q '\.firn/lock' "$sandbox/log/descriptors" || fail "the program inherits the lock"
}

case_a_second_start_takes_less_than_half_a_second() {
  rm "$sandbox/bin/cmake"
  cat >"$tree/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.22)
project(small LANGUAGES CXX)
file(GLOB sources CONFIGURE_DEPENDS *.cpp)
add_executable(firn ${sources})
END
  echo 'int main() { return 0; }' >"$tree/main.cpp"
  local best=1000000 start
  PATH="$sandbox/bin:$PATH" # cmake and the compiler are the real ones
  "$tree/firn" 2>"$sandbox/stderr" </dev/null || fail "the first start"
  for _ in 1 2 3; do
    start=${EPOCHREALTIME/./}
    "$tree/firn" 2>"$sandbox/stderr" </dev/null || fail "a second start"
    expect_silence
    if ((${EPOCHREALTIME/./} - start < best)); then best=$((${EPOCHREALTIME/./} - start)); fi
  done
  ((best < 500000)) || fail "a second start takes $best microseconds"
}

# ---

# What follows in this case runs as an ordinary user.
become_user() {
  if ((EUID != 0)); then return; fi
  chown -R 65534:65534 "$sandbox"
  prefix=(setpriv --reuid=65534 --regid=65534 --clear-groups)
  ln -s "$(command -v setpriv)" "$sandbox/bin/setpriv"
}

run_case() (
  prefix=()
  set_up
  trap 'rm -rf -- "$sandbox"' EXIT
  : >"$sandbox/stdout"
  : >"$sandbox/stderr"
  unset FIRN_BUILD FIRN_BUILD_TYPE FIRN_CMAKE_ARGS FIRN_JOBS FIRN_NO_INSTALL FIRN_DEVELOP FIRN_STOP_AFTER
  "case_$1"
)

names=$(declare -F | sed -n 's/^declare -f case_//p')
for name in ${1:-$names}; do
  if ! declare -F "case_$name" >/dev/null; then
    printf 'no case %s; there are:\n%s\n' "$name" "$names" >&2
    exit 2
  fi
  run_case "$name"
  printf 'passed: %s\n' "$name"
done
