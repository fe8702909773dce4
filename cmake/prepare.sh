# Sourced by ./run, ./test and .ci/run: from a fresh clone on Debian to a build folder. Says nothing when all is in place.
# Needs $root, the folder of the clone.

say() { printf '%s\n' "$*" >&2; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else
    say "These Debian packages are missing: ${missing[*]}"
    say "Installing them needs root or sudo; neither is there. As root: apt-get install --no-install-recommends ${missing[*]}"
    exit 1
  fi
}

# Sets the array `missing` to the packages of the list that are not installed.
find_missing_packages() {
  local package installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' 2>/dev/null | sed -n 's/^installed //p')
  missing=()
  while read -r package; do
    grep -qxF "$package" <<<"$installed" || missing+=("$package")
  done <"$root/cmake/debian-packages.txt"
}

# Whether apt knows where to get all that is missing: on a fresh system it knows nothing yet.
apt_knows_all() {
  local package
  for package in "${missing[@]}"; do
    LC_ALL=C apt-cache policy "$package" 2>/dev/null | grep -q 'Candidate: [^(]' || return 1
  done
}

apt_install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
}

install_missing_packages() {
  if ! command -v dpkg-query >/dev/null; then
    command -v cmake >/dev/null && command -v ninja >/dev/null && return
    say "This is no Debian; please install what cmake/debian-packages.txt names in your system's words."
    exit 1
  fi
  find_missing_packages
  [ ${#missing[@]} = 0 ] && return
  say "Installing ${missing[*]} ..."
  apt_knows_all || as_root apt-get update -qq >&2
  # Lists that are old name packages that are gone: once more with new ones.
  apt_install || { as_root apt-get update -qq >&2 && apt_install; } || { say "The packages could not be installed."; exit 1; }
}

# configure FOLDER [cmake options...]: once; a folder that was made in another place is made anew.
configure() {
  local folder=$1
  shift
  if [ -f "$folder/CMakeCache.txt" ] && ! grep -qF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
    rm -rf "$folder"
  fi
  [ -f "$folder/build.ninja" ] && return
  say "Configuring $folder ..."
  mkdir -p "$folder"
  cmake -G Ninja -S "$root" -B "$folder" "$@" >"$folder/configure.log" 2>&1 || {
    cat "$folder/configure.log" >&2
    rm -f "$folder/build.ninja"
    say "Configuring failed."
    return 1
  }
}

# Ninja's words on stderr: its steps as one changing line on a terminal and not elsewhere, errors and warnings in full.
show_steps() {
  local line shown=
  while IFS= read -r line; do
    case $line in
      'ninja: no work to do.' | 'ninja: Entering directory'* | '[0/'* | '') ;;
      '['[0-9]*) [ -t 2 ] && shown=1 && printf '\r\033[K%.78s' "$line" >&2 ;;
      *) printf '%s%s\n' "${shown:+$'\r\033[K'}" "$line" >&2; shown= ;;
    esac
  done
  [ -z "$shown" ] || printf '\r\033[K' >&2
}

# build FOLDER [ninja arguments...]: silent when nothing is to do. Callers set pipefail.
build() {
  local folder=$1
  shift
  [ -f "$folder/.ninja_log" ] || say "Building in $folder ..."
  ninja -C "$folder" "$@" 2>&1 | show_steps
}
