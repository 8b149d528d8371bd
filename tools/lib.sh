# SPDX-License-Identifier: Apache-2.0
# Shared by the scripts in this folder, which source it. Leaves the caller in the top folder of the checkout.
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '== %s\n' "$*"; }

# Installs the Debian packages of the given purposes (first column of packages.txt) that are missing.
install_packages() {
  local purposes=" $* " purpose package reason
  local missing=()
  while read -r purpose package reason; do
    [[ $purposes == *" $purpose "* ]] || continue
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
  done < tools/packages.txt
  [[ ${#missing[@]} -gt 0 ]] || return 0
  say "installing ${missing[*]}"
  local as_root=(env DEBIAN_FRONTEND=noninteractive)
  [[ $(id -u) -eq 0 ]] || as_root=(sudo "${as_root[@]}")
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# build PRESET [argument of cmake --build ...]
build() {
  local preset=$1
  shift
  say "building ($preset)"
  cmake --preset "$preset" --log-level=WARNING > /dev/null
  cmake --build --preset "$preset" "$@"
}
