"""Drives both motors and keeps the line busy until somebody ends it: the client that is killed in mid-motion.

Usage: driving_client.py PORT TIMEOUT_MS. The time-out is set on the controller's USB stream first.
"""

import sys
import time

from packet import Client, Port

USB_STREAM = 0
PACKET_SERIAL = 1
HALF_DUTY = 16384


def main():
    client = Client(Port(sys.argv[1]))
    client.write(145, USB_STREAM, PACKET_SERIAL, 115200, int(sys.argv[2]))
    client.write(34, HALF_DUTY, -HALF_DUTY)
    print("driving", flush=True)
    while True:
        client.read(49)
        time.sleep(0.02)


if __name__ == "__main__":
    main()
