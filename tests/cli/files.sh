# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Nothing that is read is ever written: each option that takes a file to read against each that takes one to write, by
# the same name, a link, a hard link, and a link to what is not there yet. Both lists are taken from --help-all.

# named VERB TYPE: the options, and the words without a dash, whose value is of that type.
named() {
  "$program" "$1" --help-all | awk -v type="$2" '
    type == "FILE" && $1 ~ /^[A-Z]+$/ && /^  [A-Z]/ { print $1; next } # the words without a dash are all read
    /^  [-A-Z]/ {
      for (i = 1; i <= NF; ++i) if ($i == type) {
        name = ""
        for (k = 1; k < i; ++k) { gsub(/,$/, "", $k); gsub(/,--.*/, "", $k); if ($k ~ /^-/ && name == "") name = $k }
        print (name == "" ? $1 : name)
        next
      }
    }'
}

# with OPTION VALUE: as words of the command line; what has no dash is a word of its own.
with() { case $1 in -*) printf '%s\n%s\n' "$1" "$2" ;; *) printf '%s\n' "$2" ;; esac; }

# snapshot: names, kinds and contents of all that lies here.
snapshot() {
  find . -mindepth 1 ! -name out ! -name err ! -name before ! -name after -printf '%P %y %l\n' | LC_ALL=C sort
  find . -type f ! -name out ! -name err ! -name before ! -name after -exec sha256sum {} + | LC_ALL=C sort
}

# refused TEXT WORDS: status 2 for that reason, and everything as before.
refused() {
  local text=$1
  shift
  snapshot >before
  expect_error 2 "$text" "$@"
  snapshot >after
  same before after
  tried=$((tried + 1))
}

# The files that the words of a verb name when nothing is wrong.
fill_words() {
  local verb=$1 reads=$2 option positional
  words=()
  for option in $reads; do
    case $option in
      -*) ;;
      REPORT) ;; # one, and no more
      *)
        positional=cloud.ply
        case $verb in check | compare | render) positional=mesh.off ;; esac
        words+=("$positional")
        ;;
    esac
  done
}

test_what_is_read_is_not_written() {
  sphere 300 >cloud.xyz
  expect 0 cloud.xyz -o cloud.ply
  tetrahedron >mesh.off
  mkdir deep
  local verb reads writes read write way other tried=0 verbs=0 words=()
  for verb in $("$program" --help | sed -n 's/^  \([a-z]*\) .*  .*/\1/p' | sort -u); do
    "$program" "$verb" --help-all >/dev/null 2>&1 || continue
    verbs=$((verbs + 1))
    reads=$(named "$verb" FILE)
    writes=$(named "$verb" OUTPUT)
    [ -n "$reads" ] || [ "$verb" = demo ] || die "$verb reads nothing?"
    for write in $writes; do
      fill_words "$verb" "$reads"
      local output=result.ply extra=()
      [ "$verb" != render ] || output=result.png
      [ "$write" = -o ] || ! grep -qx -- -o <<<"$writes" || extra=(-o "$output")
      for read in $reads; do
        for way in same dotted link hard through; do
          rm -f read.* other.*
          other=read.ply
          [ "$write" != -o ] || other=read.${output##*.}
          cp cloud.ply "$other"
          case $way in
            same) name=$other ;;
            dotted) name=deep/../$other ;;
            link) ln -s "$other" other.${other##*.} && name=other.${other##*.} ;;
            hard) ln "$other" other.${other##*.} && name=other.${other##*.} ;;
            through) # the input is named by the link
              mv "$other" other.${other##*.} && ln -s "other.${other##*.}" "$other" && name=other.${other##*.}
              ;;
          esac
          # shellcheck disable=SC2046
          refused "would overwrite an input" "$verb" "${words[@]}" $(with "$read" "$other") "${extra[@]}" $(with "$write" "$name")
        done
        # Neither the input nor what the output's link leads to is there.
        rm -f read.* other.*
        ln -s absent.${output##*.} other.${output##*.}
        # shellcheck disable=SC2046
        refused "would overwrite an input" "$verb" "${words[@]}" $(with "$read" absent.${output##*.}) "${extra[@]}" \
          $(with "$write" other.${output##*.})
        rm -f other.*
      done
    done
  done
  echo "$tried runs of $verbs verbs were refused"
  [ "$tried" -ge 100 ] || die "only $tried runs"
}

test_two_outputs_are_two_files() {
  sphere 300 >cloud.xyz
  local tried=0
  refused "the same file" cloud.xyz -o mesh.ply --report mesh.ply
  refused "the same file" cloud.xyz -o mesh.ply --report ./mesh.ply
  ln -s mesh.ply link
  refused "the same file" cloud.xyz -o mesh.ply --report link
  ln -s link other
  refused "the same file" cloud.xyz -o mesh.ply --report other
  touch mesh.ply
  refused "the same file" cloud.xyz -o mesh.ply --report other
  ln mesh.ply hard
  refused "the same file" cloud.xyz -o mesh.ply --report hard
}

test_what_lies_beside_a_cloud_is_not_written() {
  sphere 300 >cloud.xyz
  expect 0 cloud.xyz -o cloud.ply
  mkdir sparse
  printf 'x' >cloud.ply.vis
  printf '# no image\n' >images.txt
  local tried=0
  refused "would overwrite an input" cloud.ply -o mesh.ply --report cloud.ply.vis
  refused "would overwrite an input" cloud.ply -o mesh.ply --report images.txt
  ln cloud.ply.vis hard
  refused "would overwrite an input" cloud.ply -o mesh.ply --report hard
}

test_what_lies_in_the_folder_of_the_stages_is_not_written() {
  sphere 300 >cloud.xyz
  local tried=0
  mkdir stages
  cp cloud.xyz stages/01_surface.ply
  refused "could overwrite an input" stages/01_surface.ply -o mesh.ply --dump-stages stages
  ln stages/01_surface.ply hard.xyz
  refused "could overwrite an input" hard.xyz -o mesh.ply --dump-stages stages
  refused "could be the same file" cloud.xyz -o stages/02_surface.ply --dump-stages stages
  ln -s stages also
  refused "could overwrite an input" hard.xyz -o mesh.ply --dump-stages also
}

# A type of its own for whatever a word names; an option of no declared type would not be compared.
test_every_option_says_what_its_word_is() {
  local verb
  for verb in reconstruct orient classify info check compare render demo; do
    "$program" "$verb" --help | grep -E '^  (-.*(file|report|folder|dump|output)|[A-Z])' | grep -viE 'FILE|OUTPUT|FOLDER' |
      grep -E 'TEXT' >untyped || true
    [ ! -s untyped ] || die "$verb: $(cat untyped)"
  done
}

test_devices_hold_nothing_that_is_lost() {
  sphere 300 >cloud.xyz
  ln -s /dev/null mesh.ply
  expect 0 cloud.xyz -o mesh.ply --report /dev/null
}
