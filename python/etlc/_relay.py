"""The program that `etlc embed` runs as its encoder, for a model in another process.

It passes frames on to the process that listens at $ETLC_PYTHON_ENCODER, and its embeddings back.
"""

import os
import socket
import sys
import threading


def _pass_on(read: int, to: socket.socket) -> None:
    while data := os.read(read, 1 << 20):
        to.sendall(data)
    to.shutdown(socket.SHUT_WR)


def main() -> None:
    with socket.socket(socket.AF_UNIX) as model:
        model.connect(os.environ["ETLC_PYTHON_ENCODER"])
        model.sendall(os.environ["ETLC_ENCODER"].encode() + b"\n")
        threading.Thread(target=_pass_on, args=(0, model), daemon=True).start()
        while data := model.recv(1 << 20):
            sys.stdout.buffer.write(data)
            sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
