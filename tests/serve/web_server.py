#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 the osgGeoFX authors
"""A web server on this machine, as far away as wanted: it serves a folder and waits before each answer.

    web_server.py FOLDER [--port 8000] [--delay MILLISECONDS]
"""
import argparse
import functools
import http.server
import os
import re
import time


class Handler(http.server.SimpleHTTPRequestHandler):
    protocol_version = "HTTP/1.1"  # connections stay open
    delay = 0.0

    def do_GET(self):
        time.sleep(self.delay)
        wanted = re.fullmatch(r"bytes=(\d+)-(\d*)", self.headers.get("Range", ""))
        path = self.translate_path(self.path)
        if wanted and os.path.isfile(path):
            self.send_part(path, int(wanted[1]), int(wanted[2]) if wanted[2] else None)
        else:
            super().do_GET()

    def send_part(self, path, first, last):
        """The bytes `first` to `last` of a file, as GDAL asks for them."""
        size = os.path.getsize(path)
        last = size - 1 if last is None else min(last, size - 1)
        if first > last:
            self.send_response(416)
            self.send_header("Content-Range", f"bytes */{size}")
            self.send_header("Content-Length", "0")
            self.end_headers()
            return
        self.send_response(206)
        self.send_header("Content-Type", self.guess_type(path))
        self.send_header("Content-Range", f"bytes {first}-{last}/{size}")
        self.send_header("Content-Length", str(last - first + 1))
        self.send_header("Last-Modified", self.date_time_string(os.path.getmtime(path)))
        self.end_headers()
        with open(path, "rb") as file:
            file.seek(first)
            self.wfile.write(file.read(last - first + 1))

    def log_message(self, *arguments):
        pass


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 64
    disable_nagle_algorithm = True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--port", type=int, default=0, help="default: a free one")
    parser.add_argument("--port-file", help="the port is written there")
    parser.add_argument("--delay", type=float, default=0.0, help="before each answer, milliseconds")
    arguments = parser.parse_args()
    Handler.delay = arguments.delay / 1000.0
    # Header and content leave together.
    Handler.wbufsize = -1
    server = Server(("127.0.0.1", arguments.port), functools.partial(Handler, directory=arguments.folder))
    port = server.server_address[1]
    if arguments.port_file:
        with open(arguments.port_file + ".new", "w") as file:
            file.write(str(port))
        os.replace(arguments.port_file + ".new", arguments.port_file)
    else:
        print(f"http://127.0.0.1:{port}/", flush=True)
    server.serve_forever()


main()
