# For scripts of this folder: `. options.sh`.
#
# read_options "NAME… FLAG! …" "what else there may be" "$@": the option --NAME VALUE sets the variable NAME, --FLAG the variable FLAG to 1; what comes
# after them is left in the array `operands`. Where that is not how it is called, says how, and ends with status 2.
read_options() {
  local known=" $1 " others=$2 word usage
  usage=$(for word in $1; do [[ $word == *! ]] && printf ' [--%s]' "${word%!}" || printf ' [--%s %s]' "$word" "${word^^}"; done)
  shift 2
  operands=()
  while [ $# -gt 0 ]; do
    word=${1#--}
    if [[ $1 == --?* && $known == *" $word! "* ]]; then
      printf -v "$word" 1
    elif [[ $1 == --?* && $known == *" $word "* && $# -gt 1 ]]; then
      printf -v "$word" %s "$2" && shift
    elif [[ $1 == -* ]]; then
      echo "usage: $0$usage $others" >&2
      exit 2
    else
      operands+=("$1")
    fi
    shift
  done
}

# is_wanted NAME: whether it is among those of --only, or there are none.
is_wanted() { [ -z "${only:-}" ] || [[ " $only " == *" $1 "* ]]; }
