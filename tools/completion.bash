# SPDX-License-Identifier: Apache-2.0
# Completes the commands and options of lacuna in bash. The program's own help has them.
# shellcheck shell=bash

_lacuna() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} words=
  if ((COMP_CWORD == 1)); then
    words=$("$program" --help 2>/dev/null | sed --quiet '/^Subcommands:/,$s/^  \([a-z-]*\) .*/\1/p')
  elif [[ $word == -* ]]; then
    words=$("$program" "${COMP_WORDS[1]}" --help-all 2>/dev/null | sed --quiet 's/^  \(-h,\)\?\(--[a-z-]*\).*/\2/p')
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _lacuna lacuna
