# shellcheck shell=bash disable=SC2154  # place, system, logs and settings are those of the script
# Clean installations of Debian, for scripts that source this file: `newcomer` and `release`. It expects $place, a folder for
# them, and $logs. Packages come from where this machine's apt and npm get theirs, through its proxies, with its certificates.

# can_make_systems SCRIPT: ends the script with the reason where this machine cannot make one.
can_make_systems() {
  local program
  for program in debootstrap unshare git; do
    if ! PATH=$PATH:/usr/sbin command -v "$program" >/dev/null; then
      echo "$1: there is no $program; install it: apt-get install $program" >&2
      return 1
    fi
  done
  if [ "$(id -u)" != 0 ]; then
    echo "$1: only root may make a system and enter it; run it with sudo." >&2
    return 1
  fi
}

# archives: where this machine's apt has Debian from, one a line: its label and its address.
# shellcheck disable=SC2016  # apt's own variables
archives() { apt-get indextargets --format '$(LABEL) $(REPO_URI)' 'Identifier: Packages' 'Origin: Debian' | sort -u; }

# has_suite ADDRESS SUITE: asked with apt's own settings.
has_suite() { /usr/lib/apt/apt-helper download-file "$1dists/$2/InRelease" "$place/debian-suite" >/dev/null 2>&1; }

# sources SUITE: the suite, its updates and its security updates, as apt's list of sources.
sources() {
  local label address suite
  while read -r label address; do
    for suite in "$1" "$1-updates" "$1-security"; do
      case $label:$suite in
        Debian-Security:*-security | Debian:"$1" | Debian:*-updates)
          if has_suite "$address" "$suite"; then echo "deb $address $suite main"; fi
          ;;
      esac
    done
  done < <(archives)
}

# hand_over VARIABLE...: those that are set here, as VARIABLE=value; a file that one names is copied to the same place.
hand_over() {
  local name
  for name in "$@"; do
    if [ -z "${!name:-}" ]; then continue; fi
    if [ -f "${!name}" ]; then install -D -m 644 "${!name}" "$system${!name}"; fi
    echo "$name=${!name}"
  done
}

# npm_settings: those of this machine's npm that say how a registry is reached, as npm reads them from its environment.
npm_settings() {
  local name value
  if ! command -v npm >/dev/null; then return; fi
  for name in registry proxy https-proxy noproxy cafile; do
    value=$(npm config get "$name" 2>/dev/null) || continue
    if [ -n "$value" ] && [ "$value" != null ]; then export "npm_config_${name//-/_}=$value"; fi
  done
}

# host_settings: how this machine reaches the network, as VARIABLE=value; `inside` hands them on as "settings".
host_settings() {
  npm_settings
  hand_over http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY SSL_CERT_FILE CURL_CA_BUNDLE NODE_EXTRA_CA_CERTS \
    npm_config_registry npm_config_proxy npm_config_https_proxy npm_config_noproxy npm_config_cafile
}

# make_system SUITE: a minimal system in $system.
make_system() {
  local main
  main=$(archives | sed -n 's/^Debian //p' | head -1)
  if [ -z "$main" ]; then
    echo "apt does not know where Debian's packages are; run apt-get update first." >&2
    return 1
  fi
  debootstrap --variant=minbase --include=ca-certificates,git "$1" "$system" "$main" >"$logs/$1-debootstrap.log" 2>&1 ||
    { tail -20 "$logs/$1-debootstrap.log" >&2; return 1; }
  sources "$1" >"$system/etc/apt/sources.list"
  apt-config dump | grep -iE '^Acquire::(https?|ftp|Check|Retries)' >"$system/etc/apt/apt.conf.d/00host" || true
  cp /etc/resolv.conf /etc/hosts "$system/etc/"
}

# inside SECONDS COMMAND...: in the system's $inside_folder, with file systems and processes that end with the command.
inside_folder=/srv/tunewright
inside() {
  local seconds=$1
  shift
  # shellcheck disable=SC2016  # the inner shell is the one to read them
  timeout --foreground "$seconds" unshare --mount --pid --fork --kill-child bash -c '
    system=$1; shift
    mount --bind "$system" "$system"
    mount -t proc proc "$system/proc"
    mount -t sysfs -o ro sysfs "$system/sys"
    mount --bind /dev "$system/dev"
    mount -t devpts -o ptmxmode=666 devpts "$system/dev/pts"
    mount -t tmpfs -o mode=1777 tmpfs "$system/dev/shm"
    exec chroot "$system" env -i "$@"' inside "$system" \
    HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${settings[@]}" \
    bash -c 'cd "$1" && shift && exec "$@"' inside "$inside_folder" "$@"
}


# unpack_packages ARCHITECTURE SUITE FOLDER PACKAGE...: these packages of the suite with all that they depend on, for any
# architecture, unpacked into the folder. Nothing of this machine is changed and nothing of the packages is run. A package
# with a minus in front comes without its dependencies. The packages themselves stay in FOLDER.packages.
unpack_packages() {
  local architecture=$1 suite=$2 folder=$3 apt=$3.packages file package names=() alone=()
  shift 3
  for package in "$@"; do
    if [ "${package#-}" = "$package" ]; then names+=("$package"); else alone+=("${package#-}"); fi
  done
  rm -rf "$folder" "$apt"
  mkdir -p "$apt"/{lists,archives}/partial "$folder/usr"/{lib,lib64,bin,sbin}
  : >"$apt/status"
  sources "$suite" >"$apt/sources.list"
  cat >"$apt/apt.conf" <<EOF
#clear APT::Architectures;
APT::Architecture "$architecture";
APT::Architectures { "$architecture"; };
APT::Sandbox::User "$(id -un)";
Dir::State "$apt";
Dir::State::status "$apt/status";
Dir::Cache "$apt";
Dir::Etc::sourcelist "$apt/sources.list";
Dir::Etc::sourceparts "/dev/null";
EOF
  export APT_CONFIG=$apt/apt.conf
  apt-get update -q
  apt-get install -q -y --no-install-recommends --download-only "${names[@]}"
  if [ ${#alone[@]} != 0 ]; then (cd "$apt/archives" && apt-get download -q "${alone[@]}"); fi
  unset APT_CONFIG
  # As on every Debian of today; packages of Debian 12 still name both places.
  for file in lib lib64 bin sbin; do ln -s "usr/$file" "$folder/$file"; done
  for file in "$apt"/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$file" | tar -x --keep-directory-symlink --no-same-owner -C "$folder"
  done
  # Links that begin at the root lead out of the folder.
  find "$folder" -type l -lname '/*' -print0 | while IFS= read -r -d '' file; do
    ln -sfnr "$folder$(readlink "$file")" "$file"
  done
}

# record_packages FOLDER: writes the database by which dpkg-shlibdeps finds the package of a library of the folder, and the
# version of it that a program needs.
record_packages() {
  local folder=$1 info=$1/var/lib/dpkg/info package name part
  rm -rf "$folder/var/lib/dpkg"
  mkdir -p "$info"
  echo 1 >"$info/format"
  for package in "$folder".packages/archives/*.deb; do
    { dpkg-deb -f "$package" | sed '1a Status: install ok installed'; echo; } >>"$folder/var/lib/dpkg/status"
    name=$(dpkg-deb -f "$package" Package)
    if [ "$(dpkg-deb -f "$package" Multi-Arch)" = same ]; then name+=:$(dpkg-deb -f "$package" Architecture); fi
    # A library is found under /usr/lib, also one that its package puts into /lib.
    dpkg-deb --fsys-tarfile "$package" | tar -t | sed -E "s!^[.]/(lib/)?!/\\1!; s!^/lib/!/usr/lib/!; s!^!$folder!; s!/\$!!" >"$info/$name.list"
    for part in symbols shlibs; do
      dpkg-deb --ctrl-tarfile "$package" | tar -xO "./$part" >"$info/$name.$part" 2>/dev/null || rm "$info/$name.$part"
    done
  done
}
