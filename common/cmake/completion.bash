# Completion for every program of Footing. What it offers is read from the program's own --help: subcommands, options,
# and the values that an option names.

# Subcommands in the help on standard input.
_footing_subcommands() {
  awk '/^Subcommands:/ { inside = 1; next } /^[^ ]|^$/ { inside = 0 } inside && /^  [^ ]/ { print $1 }'
}

# Options in the help on standard input: "  -q,--quiet   text", "  --seed UINT=1   text".
_footing_options() {
  awk '/^  -/ { count = split($1, names, ","); for (i = 1; i <= count; ++i) print names[i] }'
}

# The values of the option $1: "{0,2,4}", or words at the end of "Engine: gait or pose (default: gait)".
_footing_values() {
  awk -v option="$1" '
    /^  -/ { inside = $1 ~ ("(^|,)" option "$"); text = "" }
    /^[^ ]|^$/ { inside = 0 }
    inside { text = text " " $0 }
    inside && match(text, /:\{[^}]*\}/) { found = substr(text, RSTART + 2, RLENGTH - 3) }
    inside && !match(text, /:\{/) && match(text, /: [a-z0-9_-]+(, [a-z0-9_-]+)* or [a-z0-9_-]+( \(|;|$)/) {
      found = substr(text, RSTART + 2, RLENGTH - 2); sub(/( \(|;)$/, "", found); sub(/ or /, ",", found)
    }
    END { gsub(/[ ,]+/, "\n", found); print found }'
}

_footing() {
  local program=$1 current=$2 previous=$3 help candidates word path=()
  program=${program/#\~/$HOME}
  help=$("$program" --help 2>/dev/null </dev/null) || return 0
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if _footing_subcommands <<<"$help" | grep -qxF -- "$word"; then
      path+=("$word")
      # Options of the program may follow its subcommand.
      help=$("$program" "${path[@]}" --help 2>/dev/null </dev/null)$'\n'$(grep '^  -' <<<"$help")
    fi
  done
  if [[ $previous == -* ]]; then
    candidates=$(_footing_values "$previous" <<<"$help")
  fi
  if [[ -z $candidates && $current == -* ]]; then
    candidates=$(_footing_options <<<"$help")
  elif [[ -z $candidates ]]; then
    candidates=$(_footing_subcommands <<<"$help")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$candidates" -- "$current")
}

complete -o default -F _footing "${BASH_SOURCE[0]##*/}"
