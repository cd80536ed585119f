# To source: apt with lists and a cache of its own, below a folder. The mirrors are those of this
# Debian that the machine's packages come from. apt checks their signatures. The machine's own lists
# and configuration stay as they are. No function needs root.

# own_apt_begin FOLDER KIND [ARCHITECTURE]: KIND is deb (with security updates), or deb-src (of the
# release alone). Fails where apt knows no mirror.
own_apt_begin() {
  local suite mirrors later=
  own_apt_folder=$PWD/$1
  rm -rf "$own_apt_folder"
  mkdir -p "$own_apt_folder"/{lists,cache/archives}/partial
  : >"$own_apt_folder/status" # nothing is installed
  [[ $2 == deb-src ]] || later='(-updates|-security)?'
  suite=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
  mirrors=$(apt-get indextargets --format '$(SITE) $(RELEASE) $(COMPONENT)' \
    'Created-By: Packages' |
    awk -v kind="$2" -v suites="^($suite|stable|oldstable)$later\$" '
      $2 ~ suites && $3 == "main" && !had[$0]++ {
        print kind " [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] " $0 }')
  [[ -n $mirrors ]] || { echo "apt knows no mirror of Debian ($suite)" >&2; return 1; }
  echo "$mirrors" >"$own_apt_folder/sources.list"
  own_apt_architecture=${3:-$(dpkg --print-architecture)}
}

own_apt() {
  apt-get -qq -o Dir::Etc::SourceList="$own_apt_folder/sources.list" \
    -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$own_apt_folder/lists" \
    -o Dir::State::status="$own_apt_folder/status" -o Dir::Cache="$own_apt_folder/cache" \
    -o APT::Architecture="$own_apt_architecture" -o APT::Architectures="$own_apt_architecture" \
    -o APT::Sandbox::User="$(id -un)" -o Debug::NoLocking=true "$@"
}
