# Shared by ./run, ./test and ./check: installs what packages.txt names and is missing, configures and builds.
# Sourced, not run. Sets nothing but functions.

say() { printf '==> %s\n' "$*"; }

# install_packages [check]: the list up to "# check", or all of it.
install_packages() {
  local missing=() name sudo= log
  while read -r name; do
    [ "$name" != '# check' ] || [ "${1:-}" = check ] || break
    case "$name" in '' | '#'*) continue ;; esac
    # Node of another source than Debian's brings its npm along, and Debian's cannot stand beside it.
    [ "$name" != npm ] || ! command -v npm >/dev/null || continue
    dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
  done < packages.txt
  if [ ${#missing[@]} -eq 0 ]; then say "packages: all of packages.txt${1:+ ($1)} are installed"; return; fi
  say "packages: installing ${#missing[@]} (${missing[*]})"
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "needs root or sudo to install: ${missing[*]}" >&2; exit 2; }
    sudo=sudo
  fi
  $sudo apt-get update -qq
  log=$(mktemp)
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >"$log" ||
    { grep -vE '^(Selecting|Preparing|Unpacking|Setting up|Processing|\(Reading)' "$log" | tail -n 40 >&2; exit 3; }
  rm -f "$log"
}

# configure PRESET [-DNAME=VALUE...]: nothing to do where it is configured and no value is given.
configure() {
  local preset=$1 log; shift
  [ ! -f "build/$preset/build.ninja" ] || [ $# -gt 0 ] || return 0
  say "configure: preset $preset${*:+ ($*)}"
  log=$(mktemp)
  cmake --preset "$preset" "$@" >"$log" 2>&1 || { cat "$log" >&2; rm -f "$log"; exit 3; }
  rm -f "$log"
}

# build PRESET [TARGET...]
build() {
  local preset=$1; shift
  configure "$preset"
  say "build: preset $preset"
  cmake --build --preset "$preset" ${1:+--target "$@"} || exit 3
}
