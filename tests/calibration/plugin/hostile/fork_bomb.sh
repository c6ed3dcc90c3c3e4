# 300 processes at most.
i=0
while [ $i -lt 300 ]; do
  sh -c 'sleep 8; :' "$1" &
  i=$((i + 1))
done
wait
