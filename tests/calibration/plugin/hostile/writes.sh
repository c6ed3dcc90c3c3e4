for folder in /tmp /var/tmp /dev/shm "$HOME" . ..; do
  echo "$1" > "$folder/$1"
done 2>/dev/null
mkdir "$1.folder" 2>/dev/null
ln -s /etc/passwd "$1.link" 2>/dev/null
exit 0
