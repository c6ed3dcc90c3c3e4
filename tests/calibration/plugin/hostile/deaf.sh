# Never reads its input.
exec sleep 8
