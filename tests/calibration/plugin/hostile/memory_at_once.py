"""More than the machine has, in one piece."""
held = bytearray(10**13)
