#!/usr/bin/env bash
# Meshes and logs through pipes: - as an input and as an output is the same as a file, and what
# cannot be is refused.
#   pipes.sh QTET-PROGRAM FOLDER-TO-WRITE-TO
set -euo pipefail
mkdir -p "$2/temporary"
cd "$2"
export TMPDIR=$PWD/temporary
qtet=$1
fail() { echo "pipes: $1" >&2; exit 1; }
# refuses EXIT-CODE WORD WORDS...: with an empty standard input
refuses() {
  local code=0
  "$qtet" "${@:3}" </dev/null >out.txt 2>err.txt || code=$?
  [[ $code == "$1" && ! -s out.txt ]] && grep -q -- "$2" err.txt || {
    cat err.txt >&2
    fail "${*:3} ended with $code"
  }
}
# The line of --json that states a member.
member() { "$qtet" "${@:2}" --json | grep "\"$1\""; }

"$qtet" sample box -o box.vtu >/dev/null
"$qtet" simplify box.vtu -o box.qtet 2>/dev/null >/dev/null
"$qtet" simplify - --format vtu -o piped.qtet <box.vtu 2>/dev/null >/dev/null
[[ $(member meshDigest verify - <piped.qtet) == $(member meshDigest verify box.qtet) ]] ||
  fail "a mesh from a pipe is another one"
cat box.qtet | "$qtet" info - --json | cmp - <("$qtet" info box.qtet --json) ||
  fail "info of a pipe"
cat box.vtu | "$qtet" check - --format .vtu 2>/dev/null | grep -q "simplify takes it" ||
  fail "check of a pipe"
"$qtet" extract box.qtet --ratio 0.3 -o level.vtu >/dev/null
"$qtet" extract - --ratio 0.3 --to vtu -o - <box.qtet 2>err.txt | cmp - level.vtu ||
  fail "extract from pipe to pipe"
grep -q 'note: level' err.txt || fail "extract says nothing beside its output"
"$qtet" extract - --ratio 0.3 --to vtu -o - --quiet <box.qtet 2>err.txt | cmp - level.vtu ||
  fail "--quiet took the output"
[[ ! -s err.txt ]] || fail "--quiet still talks"
"$qtet" convert - --format=vtu --to msh -o - <box.vtu 2>/dev/null |
  "$qtet" convert - --format msh -o back.vtu >/dev/null 2>&1
"$qtet" convert box.vtu -o straight.vtu >/dev/null 2>&1
[[ $(member tetrahedra check back.vtu) == $(member tetrahedra check straight.vtu) ]] ||
  fail "convert through two pipes"
gzip -c box.vtu >box.vtu.gz
for format in vtu vtu.gz; do
  "$qtet" convert - --format $format -o back.vtu <box.vtu.gz >/dev/null 2>&1
  cmp back.vtu straight.vtu || fail "a compressed mesh as $format"
done
"$qtet" convert <(cat box.vtu.gz) --format vtu -o back.vtu >/dev/null 2>&1
cmp back.vtu straight.vtu || fail "a compressed mesh of a pipe"
rm -f box.again.vtu.gz  # of an earlier run
mkfifo box.again.vtu.gz
cat box.vtu.gz >box.again.vtu.gz &
"$qtet" check box.again.vtu.gz | grep -q "simplify takes it" || fail "a named pipe of gzip"
wait
cp box.vtu nameless
"$qtet" check nameless --format vtu >/dev/null 2>&1 ||
  fail "--format of a file whose name says nothing"
# every command that writes one file, with its messages beside it
for words in "sample box" "simplify box.vtu" "add-field box.qtet --from box.vtu --replace" \
  "add-steps box.qtet box.vtu --times 1 --fields Scalar" "remove-field box.qtet --fields Scalar"; do
  ending=qtet
  [[ $words != sample* ]] || ending=vtu
  # shellcheck disable=SC2086
  "$qtet" $words -o beside.$ending >said.txt 2>/dev/null || fail "$words"
  # shellcheck disable=SC2086
  "$qtet" $words -o - 2>err.txt | cmp - beside.$ending || fail "$words -o -"
  grep -q '^qtet: note: the standard output' err.txt || fail "$words -o - says nothing"
  ! grep -qv '^qtet: ' err.txt || fail "$words -o -: messages without a mark"
  [[ $(wc -l <said.txt) == $(grep -c '^qtet: note: ' err.txt) ]] || fail "$words -o -: other words"
done
[[ ! -e ./- ]] || fail "a file was called -"
"$qtet" sample box -o - 2>/dev/null | "$qtet" simplify - --format vtu -o - 2>/dev/null |
  "$qtet" info - | grep -q '3,072 tetrahedra' || fail "three commands in a row"
refuses 2 'both want' simplify box.vtu -o - --json
if command -v script >/dev/null; then
  for words in "sample box -o -" "simplify box.vtu -o -" \
    "extract box.qtet --level 0 --to vtu -o -"; do
    script -qec "'$qtet' $words" tty.txt >out.txt </dev/null && fail "$words to a terminal"
    grep -q 'which is a terminal' out.txt || fail "$words to a terminal: $(head -c 200 out.txt)"
  done
fi
refuses 2 '--format' check -
refuses 2 'given once' simplify - - --format vtu -o x.qtet
refuses 2 '--to' extract box.qtet --level 0 -o -
refuses 1 'is empty' check - --format vtu
refuses 2 'must end in' convert box.vtu --to exe -o -
[[ -z $(ls temporary) ]] || fail "left behind: $(ls temporary)"
echo "pipes: the same as files"
