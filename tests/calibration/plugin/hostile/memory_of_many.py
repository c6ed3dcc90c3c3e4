"""600 MB in ten processes, none of which has much."""
import os
import time

for _ in range(10):
    if os.fork() == 0:
        held = b"x" * 60_000_000
        time.sleep(8)
        os._exit(0)
time.sleep(8)
