# SPDX-License-Identifier: Apache-2.0
# Sourced by scripts that have options: goes to the project's folder, and reads the command line as their `usage` says.
# shellcheck shell=bash

invoked_from=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD

fail() {
  echo "$(basename "$0"): $1" >&2
  exit "${2:-1}"
}

from_caller() { [[ $1 == /* ]] && echo "$1" || echo "$invoked_from/$1"; }

# Every option has a line of `usage`, "  --peer-points N   ...", and sets the variable peer_points to what follows it.
# Without a word in capitals it sets it to 1. A LIST becomes an array, a DIR, FILE or PROGRAM is sought from where the
# caller is. What stands behind -- becomes detect_options.
parse_options() {
  local line name
  while (($# > 0)); do
    case $1 in
      -h | --help)
        usage
        exit 0
        ;;
      --)
        detect_options=("${@:2}")
        return
        ;;
    esac
    line=$'\n'"  $1( ([A-Z]+))? "
    if [[ ! $1 =~ ^--[a-z-]+$ || ! $(usage) =~ $line ]]; then
      usage >&2
      fail "unknown option $1" 2
    fi
    name=${1:2}
    name=${name//-/_}
    [[ -z ${BASH_REMATCH[2]} ]] || (($# > 1)) || fail "$1 needs a value" 2
    case ${BASH_REMATCH[2]} in
      "") printf -v "$name" 1 ;;
      LIST) read -r -a "$name" <<<"$2" && shift ;;
      DIR | FILE | PROGRAM) printf -v "$name" %s "$(from_caller "$2")" && shift ;;
      *) printf -v "$name" %s "$2" && shift ;;
    esac
    shift
  done
}
