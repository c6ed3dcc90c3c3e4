for k in 1 2 3 4; do
  sh -c 'i=0; while [ $i -lt 100000000 ]; do i=$((i + 1)); done' "$1" &
done
wait
