# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# What scripts/numbers.py and scripts/lines.sh find in sources that are known.

test_numbers_are_listed_with_name_and_comment() {
  local python
  python=$(command -v python3) || skip "there is no python3"
  cat >known.cpp <<'END'
// 77 in a comment

/// Why: measured.
constexpr double share = 0.25, other = 1.0;
const char* text = "88 99";
constexpr std::size_t big = 1'000'000; // samples
constexpr std::uint64_t hash = 0x9e3779b97f4a7c15ull;
int f(int k, std::array<int, 4> a) {
  for (int i = 0; i < 3; ++i) a[(k + 3) % 4] += a[3];
  return 2u * a[k % 3] + 1.5e-3f * 0x2;
}
END
  "$python" "$repository/scripts/numbers.py" known.cpp >found
  cat >expected <<'END'
known.cpp:4: 0.25  share  Why: measured.
known.cpp:6: 1'000'000  big  samples
known.cpp:7: 0x9e3779b97f4a7c15ull  hash  (no comment)
known.cpp:10: 1.5e-3f  -  (no comment)
4 numbers in 1 files of known.cpp: 3 with a name, 2 with a comment; 6 structural ones skipped
END
  diff expected found || die "numbers.py found something else"
  "$python" "$repository/scripts/numbers.py" --bare known.cpp >bare
  equal "numbers without a comment" "$(grep -c 'no comment' bare)/$(wc -l <bare)" "2/3"
}

test_long_functions_and_files_are_found() {
  command -v git >/dev/null || skip "there is no git"
  mkdir -p scripts src/io include
  cp "$repository/scripts/lines.sh" scripts
  {
    printf 'namespace {\nclass A {\n  void short_one() const {\n    work();\n  }\n\n  int long_one(int a,\n               int b) {\n'
    for _ in $(seq 58); do echo '    if (a) {'; echo '    }'; done
    printf '  }\n};\n} // namespace\n'
  } >src/a.cpp
  for _ in $(seq 601); do echo '// line'; done >src/io/b.h
  git init -q . && git add .
  bash scripts/lines.sh >found && die "lines.sh finds nothing too long"
  equal "lines without io" "$(awk '/src and include/ { print $1 }' found)" "$(wc -l <src/a.cpp)"
  grep -q 'src/a.cpp:7: 119 lines: .*long_one' found || die "the long function is not found: $(cat found)"
  grep -q 'functions over 60 lines: 1$' found || die "other functions are found, too: $(cat found)"
  grep -q 'src/io/b.h: 601 lines' found || die "the long file is not found: $(cat found)"
}
