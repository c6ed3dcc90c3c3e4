"""1 GB, as a program takes it that touches all that it has."""
import time

held = []
for _ in range(50):
    held.append(b"x" * 20_000_000)
time.sleep(8)
