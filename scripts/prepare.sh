# Shared by ./run and ./test: installs what packages.txt names and is missing, configures and builds.
# Sourced, not run. Sets nothing but functions.

say() { printf '==> %s\n' "$*"; }

install_packages() {
  local missing=() name sudo=
  while read -r name; do
    case "$name" in '' | '#'*) continue ;; esac
    dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
  done < packages.txt
  if [ ${#missing[@]} -eq 0 ]; then say "packages: all of packages.txt are installed"; return; fi
  say "packages: installing ${#missing[@]} (${missing[*]})"
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "needs root or sudo to install: ${missing[*]}" >&2; exit 2; }
    sudo=sudo
  fi
  $sudo apt-get update -qq
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# build PRESET [TARGET...]
build() {
  local preset=$1; shift
  if [ ! -f "build/$preset/build.ninja" ]; then
    say "configure: preset $preset"
    cmake --preset "$preset" >"build-$preset.log" 2>&1 || { cat "build-$preset.log" >&2; rm -f "build-$preset.log"; exit 3; }
    rm -f "build-$preset.log"
  fi
  say "build: preset $preset"
  cmake --build --preset "$preset" ${1:+--target "$@"} || exit 3
}
