[ -f "$HOME/canary" ] || exit 2  # nowhere but in the test
for file in machine.yaml "$HOME/notes.txt"; do
  chmod 666 "$file"
  echo 'name: other' > "$file"
  echo 'name: other' >> "$file"
  mv "$file" "$file.old"
  truncate -s 0 "$file"
done 2>/dev/null
exit 0
