#!/usr/bin/env bash
# Keeps the arrows between the rooms: proto <- codec <- simplify, and proto, codec <- server. In the
# page they are core <- webgl <- three, viewer, and the folders in them. Inside a room neither files
# nor folders may stand in a circle.
#   check.sh [ROOT]   0 = all hold
#                     1 = every arrow that breaks is named as file:line, with what to do
set -euo pipefail
shopt -s nullglob globstar

root=${1:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
cd "$root"

# Which rooms a room may include, besides itself.
declare -A allowed=([proto]="" [codec]="proto" [simplify]="proto codec" [server]="proto codec")
# Libraries that a room must do without: codec and proto are also built for the browser.
declare -A foreign=(
  [proto]='vtk|boost/|draco/'
  [codec]='vtk|boost/asio|boost/beast'
  [simplify]='boost/asio|boost/beast'
  [server]='vtk'
)

broken=0
complain() {
  printf '%s\n' "$*"
  broken=1
}

isIn() { # word list...
  local word=$1 other
  shift
  for other in "$@"; do [[ $word == "$other" ]] && return 0; done
  return 1
}

# Lines "file line kind name", one an include; kind is its opening delimiter. Nothing that was
# built or fetched. One call for all files: most of the time would be that of starting programs.
includes() {
  local include='#[[:space:]]*include'
  find "$@" \( -name node_modules -o -name dist \) -prune -o \
    -type f -regex '.*[.]\(h\|hpp\|c\|cc\|cpp\|inc\)' -print | sort |
    xargs -r grep -HnE "^[[:space:]]*$include" |
    sed -nE "s/^([^:]+):([0-9]+):[^#]*$include[[:space:]]*([\"<])([^\">]+)[\">].*/\1 \2 \3 \4/p"
}

checkQuoted() { # file line name
  local room=${1%%/*} target=${3%%/*}
  if [[ $3 != */* || ! -e $3 ]]; then
    complain "$1:$2: \"$3\" is no file of the repository;" \
      "write includes from the root, like \"codec/mesh.h\""
  elif [[ $target != "$room" ]] && ! isIn "$target" ${allowed[$room]}; then
    complain "$1:$2: $room/ must not include \"$3\";" \
      "it may use only: $room ${allowed[$room]}"
  fi
}

checkForeign() { # file line name
  local room=${1%%/*}
  if [[ $3 =~ ^(${foreign[$room]}) ]]; then
    complain "$1:$2: $room/ must not include <$3>;" \
      "move what needs it to the room that may"
  fi
}

checkLinks() { # room: a library linked is an arrow too
  local room=$1 line name
  [[ -f $room/CMakeLists.txt ]] || return 0
  while IFS=: read -r line name; do
    [[ $name == "$room" ]] || isIn "$name" ${allowed[$room]} ||
      complain "$room/CMakeLists.txt:$line: $room/ must not link qtet::$name;" \
        "it may link only: ${allowed[$room]}"
  done < <(sed 's/#.*//' "$room/CMakeLists.txt" |
    grep -noE 'qtet::(proto|codec|simplify|server)\b' | sed 's/qtet:://' || true)
}

rooms=()
for room in proto codec simplify server; do
  [[ -d $room ]] || continue
  rooms+=("$room")
  checkLinks "$room"
done
cpp=$([[ ${#rooms[@]} == 0 ]] || includes "${rooms[@]}")
while read -r file line kind name; do
  case $kind in
    '"') checkQuoted "$file" "$line" "$name" ;;
    '<') checkForeign "$file" "$line" "$name" ;;
  esac
done <<<"$cpp"

# The viewer's own C++, if any, stands on nothing but the compiled codec.
if [[ -d web-client ]]; then
  while read -r file line kind name; do
    [[ $kind != '"' ]] || ! isIn "${name%%/*}" proto codec simplify server ||
      complain "$file:$line: web-client/ must not include \"$name\";" \
        "it uses the codec through codec/api/wasm_api.h's exports"
  done < <(includes web-client)
fi

# The page's own modules; a worker's address (new URL) is no import, so it makes no arrow.
typescriptArrows() {
  [[ -d web-client ]] || return 0
  find web-client \( -name node_modules -o -name dist -o -name tests \) -prune \
    -o -name '*.ts' -print | sort | xargs -r grep -HE "(from|import) *\(?['\"]\.\.?/" |
    sed -nE "s/^([^:]+):.*(from|import) *\(?['\"]([^'\"?]+)(\?[^'\"]*)?['\"].*/\1 \3/p" |
    awk '{
      folder = $1; sub(/[^\/]*$/, "", folder)
      n = split(folder $2, part, "/"); top = 0
      for (i = 1; i <= n; ++i) {
        if (part[i] == "." || part[i] == "") continue
        if (part[i] == "..") --top; else kept[++top] = part[i]
      }
      path = kept[1]; for (i = 2; i <= top; ++i) path = path "/" kept[i]
      print $1, path (path ~ /\.[a-z]+$/ ? "" : ".ts")
    }'
}

# tsort names the members of a circle on stderr.
checkCircles() { # what, what to do; arrows on stdin
  local loops
  loops=$(tsort 2>&1 >/dev/null) ||
    complain "$1 stand in a circle; $2:
$(sed -E 's/^tsort: (-: )?/  /' <<<"$loops")"
}

# Arrows between the folders that the files lie in.
folderArrows() { awk '{
    from = $1; to = $2; sub(/\/[^\/]*$/, "", from); sub(/\/[^\/]*$/, "", to)
    if (from != to) print from, to
  }' | sort -u; }

# Lines "from to": which file includes or imports which.
arrows=$(awk '$3 == "\"" {print $1, $4}' <<<"$cpp")
checkCircles "these files" "move what they share into a file of its own" <<<"$arrows"
checkCircles "these folders" "move what they share into the lower one" \
  < <(folderArrows <<<"$arrows")
arrows=$(typescriptArrows)
checkCircles "these modules" "move what they share into a module of its own" <<<"$arrows"

# The page's folders, each with those that it may import from: a regular expression.
declare -A below=(
  [core/protocol]=''
  [core/transport]='core/protocol'
  [core/decode]='core/protocol'
  [core/picture]='core/(protocol|decode)'
  [core/layers]='core/(protocol|picture)'
  [core/derived]='core/(protocol|picture|layers)'
  [core/integrals]='core/(protocol|picture|layers)'
  [core/lines]='core/(protocol|decode|picture)'
  [core/session]='core/(protocol|transport|decode|picture|layers|derived|integrals|lines)'
  [core/simplify]='core/protocol'
  [core]='core/.*'
  [webgl/gl]=''
  [webgl]='core(/.*)?|webgl/gl'
  [three]='core(/.*)?|webgl'
  [tool]=''
  [viewer/settings]='core(/.*)?|webgl'
  [viewer/page]='core(/.*)?|webgl|viewer/settings'
  [viewer/panels]='core(/.*)?|webgl|viewer/(settings|page)'
  [viewer/picture]='core(/.*)?|webgl|viewer/(settings|page|panels)'
  [viewer/drop]='core(/.*)?|viewer/(page|panels)'
  [viewer]='core(/.*)?|webgl|viewer/.*'
)
while read -r from to; do
  from=${from#web-client/} to=${to#web-client/}
  if [[ -z ${below[$from]+listed} ]]; then
    complain "web-client/$from/ has no place yet; say in tests/arrows/check.sh what it may import"
  elif [[ ! $to =~ ^(${below[$from]})$ ]]; then
    complain "web-client/$from/ must not import from web-client/$to/;" \
      "it may import only: ${below[$from]:-its own files}"
  fi
done < <(folderArrows <<<"$arrows")

# A folder is a room with a meaning; "common" and "utils" have none.
while IFS= read -r folder; do
  complain "$folder: no folder may be called common, util or utils;" \
    "name it after what it holds, or move its files to their room"
done < <(find . \( -name node_modules -o -name build -o -name .git \) -prune -o \
  -type d \( -iname common -o -iname util -o -iname utils \) -print | sed 's|^\./||' | sort)

if [[ $broken == 0 ]]; then echo "arrows: all hold"; fi
exit $broken
