#!/usr/bin/env bash
# In a bare Debian 12, as root: installs what packages.txt names, builds the tree of this script and installs it in
# /usr/local.   scripts/container/install.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/prepare.sh
install_packages
cmake --preset release -DUNDERSTUDY_BENCH=OFF
cmake --build --preset release
cmake --install build/release --prefix /usr/local
understudy doctor
