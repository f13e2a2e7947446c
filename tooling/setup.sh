# SPDX-License-Identifier: Apache-2.0
# Shared by ./vantage and ./check: Debian packages, configuring, building. Sourced; expects $root and $name. POSIX sh.
# Everything it says goes to stderr; full logs lie in build/logs. Set-up failures exit with 1, which the program itself never uses.

stamps=$root/build/stamps
logs=$root/build/logs

say() { printf '%s: %s\n' "$name" "$*" >&2; }
die() { say "$*"; exit 1; }

# One set-up at a time, whoever started it. Descriptor 9 holds the lock; unlock_setup lets go of it.
lock_setup() {
  mkdir -p "$stamps" "$logs" || die "cannot write into $root/build"
  command -v flock >/dev/null 2>&1 || return 0
  exec 9>"$root/build/lock"
  flock -n 9 || { say "waiting for another build in this folder"; flock 9; }
}
unlock_setup() { exec 9>&-; }

# Shows lines of stdin that match $1 (a sed script that prints what to show): in place on a terminal, else nothing.
show_progress() {
  if [ -t 2 ] && [ -z "${VANTAGE_QUIET:-}" ]; then
    width=$(stty size 2>/dev/null <&2 | cut -d' ' -f2)
    [ "${width:-0}" -gt 20 ] 2>/dev/null || width=80
    sed -un "$1" | while IFS= read -r line; do printf '\r\033[K%.*s' "$((width - 1))" "$line" >&2; done
    printf '\r\033[K' >&2
  else
    cat >/dev/null
  fi
}

# run_logged LOG SED COMMAND...: runs a command with its output in build/logs/LOG; returns its status.
run_logged() {
  log=$logs/$1
  filter=$2
  shift 2
  { "$@" 9>&- </dev/null 2>&1; echo $? >"$log.status"; } | tee "$log" | show_progress "$filter"
  return "$(cat "$log.status")"
}

# The packages of a list that dpkg does not report as installed.
missing_packages() {
  for package in $(sed 's/#.*//' "$1"); do
    case $(dpkg-query -W -f '${db:Status-Status} ' "$package" 2>/dev/null) in *installed*) ;; *) printf '%s ' "$package" ;; esac
  done
}

install_packages() {
  apt="apt-get -y -q --no-install-recommends -o Acquire::Retries=3 -o DPkg::Lock::Timeout=600"
  as_root=
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null 2>&1 || die "needs Debian packages, and is neither root nor has sudo; as root: apt-get install $*"
    say "installs Debian packages with sudo: $*"
    sudo -v || die "needs Debian packages; as root: apt-get install $*"
    as_root=sudo
  else
    say "installs Debian packages: $*"
  fi
  filter='s/^\(Get:[0-9]*\) [^ ]* [^ ]* [^ ]* \([^ ]*\).*/\1 \2/p;/^\(Unpacking\|Setting up\|Selecting\)/p'
  # A source that does not answer need not matter: the installation decides.
  run_logged apt-update.log "$filter" $as_root env DEBIAN_FRONTEND=noninteractive $apt update || say "apt-get update failed (build/logs/apt-update.log); going on"
  if ! run_logged apt-install.log "$filter" $as_root env DEBIAN_FRONTEND=noninteractive $apt install "$@"; then
    tail -n 15 "$logs/apt-install.log" >&2
    die "apt-get install failed: build/logs/apt-install.log"
  fi
}

# need_packages LISTS (files in tooling/): installs what is missing. Costs nothing while neither lists nor dpkg's state changed.
need_packages() {
  if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    # Not Debian: the tools must be there, and CMake names each library it misses.
    for tool in cmake ninja c++; do
      command -v $tool >/dev/null 2>&1 || die "this is not Debian and $tool is missing; needs what Debian calls: $(cd "$root/tooling" && sed '/^#/d' "$@" | tr '\n' ' ')"
    done
    return 0
  fi
  missing=
  for list in "$@"; do
    [ "$stamps/$list" -nt "$root/tooling/$list" ] && [ "$stamps/$list" -nt /var/lib/dpkg/status ] && continue
    missing="$missing$(missing_packages "$root/tooling/$list")"
  done
  [ -z "$missing" ] || install_packages $missing
  for list in "$@"; do touch "$stamps/$list"; done
}

# build_preset PRESET: configures if there is no build or the presets changed, and builds.
build_preset() {
  preset=$1
  folder=$root/build/$preset
  fresh=
  # A clone that was moved or copied cannot go on with CMake's absolute paths.
  if [ -f "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then fresh=--fresh; fi
  if [ -n "$fresh" ] || [ ! -f "$folder/build.ninja" ] || [ ! "$stamps/$preset.configured" -nt "$root/CMakePresets.json" ]; then
    say "configures $preset"
    run_logged "$preset-configure.log" '/^-- /p' cmake -S "$root" --preset "$preset" $fresh || { tail -n 25 "$logs/$preset-configure.log" >&2; return 1; }
    sed -n '/^-- | /s/^-- | /  /p' "$logs/$preset-configure.log" >&2
    touch "$stamps/$preset.configured"
  fi
  # The mark carries the time before the build: what is edited meanwhile is newer.
  touch "$stamps/$preset.start"
  say "builds $preset"
  if ! (cd "$root" && NINJA_STATUS='[%f/%t] ' run_logged "$preset-build.log" 's/^\(\[[0-9/]*\]\) .*\/\([^/]*\)$/\1 \2/p' cmake --build --preset "$preset"); then
    # Ninja prints the failing step's output after FAILED.
    sed -n '/^FAILED/,$p' "$logs/$preset-build.log" | grep -v '^\[[0-9]' | grep -v '^/[^ ]* .* -c /' | head -n 40 >&2
    say "the build failed: build/logs/$preset-build.log"
    return 1
  fi
  mv "$stamps/$preset.start" "$stamps/$preset.built"
}

# Whether anything the program is built from is newer than the last release build (folders too, so that deletions count).
sources_newer() {
  [ -f "$stamps/release.built" ] || return 0
  [ -n "$(cd "$root" && find src apps cmake CMakeLists.txt CMakePresets.json -newer "$stamps/release.built" -print -quit 2>/dev/null)" ]
}
