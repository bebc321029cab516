# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# What scripts/numbers.py, scripts/lines.sh and scripts/docs find in sources that are known.

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

test_dead_links_of_a_site_are_found() {
  local python
  python=$(command -v python3) || skip "there is no python3"
  mkdir -p site/sub
  echo '<h1 id="here">a</h1><a href="sub/b.html#there">b</a><a href="#here">a</a><a href="https://example.org/x">x</a>' >site/a.html
  echo '<h2 id="there">b</h2><a href="../a.html">a</a><img src="../p.png">' >site/sub/b.html
  touch site/p.png
  "$python" "$repository/scripts/docs/check_links.py" site >found || die "good links are called dead: $(cat found)"
  equal "what it says" "$(cat found)" "4 links, 0 lead nowhere"
  echo '<a href="gone.html">1</a><a href="a.html#gone">2</a><a href="#gone">3</a><a href="../out.html">4</a>' >site/c.html
  touch out.html
  "$python" "$repository/scripts/docs/check_links.py" site >found && die "dead links pass"
  equal "dead links" "$(grep -c '^c.html: ' found)" 4
}

test_declarations_of_several_names_are_all_described() {
  local python
  python=$(command -v python3) || skip "there is no python3"
  cat >known.h <<'END'
struct A {
  double low = 0, high = 1; ///< bounds
  /// Colours.
  std::array<int, 3> front{1, 2, 3}, back{4, 5, 6};
  int one = 0; ///< alone
  void call(int a, int b);
};
END
  cat >expected <<'END'
struct A {
  double low = 0; /**< bounds */ double high = 1; /**< bounds */
  /// Colours.
  std::array<int, 3> front{1, 2, 3}; /**< Colours. */ std::array<int, 3> back{4, 5, 6}; /**< Colours. */
  int one = 0; ///< alone
  void call(int a, int b);
};
END
  "$python" "$repository/scripts/docs/split_declarations.py" known.h | sed '$d' >found
  diff expected found || die "declarations are taken apart in another way"
}
