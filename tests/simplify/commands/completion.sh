#!/usr/bin/env bash
# The completions in the shells themselves: bash, and zsh and fish where they are installed.
#   completion.sh QTET-PROGRAM FOLDER-TO-WRITE-TO
set -euo pipefail
mkdir -p "$2"
cd "$2"
export PATH=$(dirname "$1"):$PATH
fail() { echo "completion: $1" >&2; exit 1; }

# offers SHELL WORD ANSWER: the answer is among what the shell would offer for the line
offers() { grep -qw -- "$3" <<<"$2" || fail "$1 offers '$2', without $3"; }

qtet completion bash >qtet.bash
# in_bash WORDS...: the last one is to be completed
in_bash() {
  bash --norc -c 'source ./qtet.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
    "$(complete -p qtet | sed "s/.*-F \([^ ]*\).*/\1/")"; printf "%s\n" "${COMPREPLY[@]}"' bash "$@"
}
offers bash "$(in_bash qtet ex)" extract
offers bash "$(in_bash qtet view --we)" --weld
offers bash "$(in_bash qtet help ex)" extract
[[ $(in_bash qtet sim) == simplify ]] || fail "bash completes sim to something else, too"

if command -v fish >/dev/null; then
  qtet completion fish >qtet.fish
  in_fish() { HOME=$PWD fish --no-config -c "source qtet.fish; complete -C '$1'"; }
  offers fish "$(in_fish 'qtet ex')" extract
  offers fish "$(in_fish 'qtet view --we')" --weld
fi

# zsh completes in a terminal alone: here no more than that it understands the file.
if command -v zsh >/dev/null; then
  qtet completion zsh >_qtet
  zsh -n _qtet || fail "zsh does not understand it"
fi
echo "completion: the shells offer what qtet knows"
