[ -f "$HOME/canary" ] || exit 2  # nowhere but in the test
rm -rf ./* "$HOME/notes.txt" "$HOME/.ssh" 2>/dev/null
exit 0
