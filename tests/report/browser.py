"""A headless Chromium, driven over its DevTools protocol, and a page in it.

Keeps true: nothing sleeps for a fixed time; a test waits for a condition on the page, and every
message on the page's console is collected.
"""

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.request

import websocket

PATIENCE = 280  # seconds; long, since a busy machine is slow


class Browser:
    def __init__(self):
        program = shutil.which("chromium") or shutil.which("chromium-browser")
        self.folder = tempfile.mkdtemp()
        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--no-first-run", "--disable-background-networking", "--disable-extensions",
             "--remote-debugging-port=0", "--remote-allow-origins=*",
             f"--user-data-dir={self.folder}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": self.folder})
        self.port = self._port()

    def _port(self):
        path = os.path.join(self.folder, "DevToolsActivePort")
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self.process.poll() is not None:
                raise RuntimeError("chromium ended before it was ready")
            if os.path.exists(path):
                lines = open(path).read().split()
                if lines:
                    return int(lines[0])
            time.sleep(0.05)
        raise RuntimeError("chromium does not answer")

    def page(self, path, width=1280, height=720):
        """Opens a file, or an address that begins with http."""
        address = f"http://127.0.0.1:{self.port}/json/new?about:blank"
        request = urllib.request.Request(address, method="PUT")
        target = json.load(urllib.request.urlopen(request, timeout=PATIENCE))
        return Page(target["webSocketDebuggerUrl"], path, width, height)

    def close(self):
        self.process.terminate()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Page:
    def __init__(self, address, path, width, height):
        self.socket = websocket.create_connection(address, timeout=PATIENCE)
        self.last = 0
        self.messages = []  # messages of the console, and exceptions
        self.requests = []  # addresses that the page requested, except its own file
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.resize(width, height)
        is_address = str(path).startswith("http")
        self.file = path if is_address else "file://" + os.path.abspath(path)
        self.call("Page.navigate", url=self.file)
        self.wait("document.readyState === 'complete'")

    def call(self, method, **parameters):
        self.last += 1
        self.socket.send(json.dumps({"id": self.last, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self.socket.recv())
            if answer.get("id") == self.last:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self._note(answer)

    def _note(self, event):
        method, of = event.get("method"), event.get("params", {})
        if method == "Runtime.consoleAPICalled":
            self.messages.append(str([arg.get("value") for arg in of["args"]]))
        elif method == "Runtime.exceptionThrown":
            self.messages.append(json.dumps(of["exceptionDetails"])[:2000])
        elif method == "Log.entryAdded":
            self.messages.append(of["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            address = of["request"]["url"]
            if address != getattr(self, "file", None) and not address.startswith("data:"):
                self.requests.append(address)

    def value(self, expression):
        """Evaluates a JavaScript expression, and waits for a promise."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {json.dumps(answer['exceptionDetails'])[:2000]}")
        return answer["result"].get("value")

    def wait(self, condition):
        end = time.monotonic() + PATIENCE
        while not self.value(condition):
            if time.monotonic() > end:
                raise RuntimeError(f"never came true: {condition}; the console: {self.messages}")
            time.sleep(0.02)

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)

    def place(self, selector):
        """Scrolls to an element; returns its centre, where a mouse would point."""
        self.value(f"document.querySelector({json.dumps(selector)}).scrollIntoView("
                   "{block: 'center', behavior: 'instant'})")
        return self.value(f"(() => {{ const box = document.querySelector({json.dumps(selector)})"
                          ".getBoundingClientRect(); return [box.x + box.width / 2, "
                          "box.y + box.height / 2, box.width, box.height]; })()")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, selector):
        x, y, *_ = self.place(selector)
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, x, y, button="left", clickCount=1)

    def key(self, key, shift=False):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=8 if shift else 0)

    def screenshot(self, path):
        image = self.call("Page.captureScreenshot", format="png")["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(image))

    def pdf(self):
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True)["data"])
