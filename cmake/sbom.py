#!/usr/bin/python3
"""Prints what a release consists of: a software bill of materials in SPDX 2.3, as JSON.

sbom.py VERSION FOLDER: the files of FOLDER with their sums, the libraries that the wheel contains,
and the Debian packages that the release was built with.
"""

import hashlib
import json
import os
import re
import subprocess
import sys
import zipfile
from datetime import datetime, timezone
from pathlib import Path


def installed(pattern, *words):
    """Returns what dpkg-query prints, as lines."""
    made = subprocess.run(["dpkg-query", *words, pattern], capture_output=True, text=True)
    return made.stdout.splitlines()


def debian(name):
    """Returns a Debian package that is installed, as a package of SPDX."""
    version, architecture = installed(name, "-W", "-f", "${Version} ${Architecture}\n")[0].split()
    return {
        "SPDXID": "SPDXRef-Debian-" + re.sub(r"[^\w.-]", "-", name).replace("_", "-"),
        "name": name,
        "versionInfo": version,
        "supplier": "Organization: Debian",
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "externalRefs": [{
            "referenceCategory": "PACKAGE-MANAGER",
            "referenceType": "purl",
            "referenceLocator": f"pkg:deb/debian/{name}@{version}?arch={architecture}",
        }],
    }  # fmt: skip


def in_wheel(wheel):
    """Returns the names of the packages whose libraries the wheel contains."""
    names = (Path(name) for name in zipfile.ZipFile(wheel).namelist())
    libraries = {name.name for name in names if name.parts[-2:-1] == ("lib",)} - {"libetlc.so.1"}
    owners = {library: installed(f"*/{library}", "-S") for library in libraries}
    lost = sorted(library for library, found in owners.items() if not found)
    if lost:
        sys.exit(f"{wheel}: no Debian package has {', '.join(lost)}")
    return {found[0].split(":")[0] for found in owners.values()}


def built_with():
    """Returns the names of the packages of packages.txt that a release is built with."""
    listed = (Path(__file__).parent / "packages.txt").read_text().splitlines()
    words = (line.split() for line in listed if not line.startswith("#"))
    return {package for group, package in words if group in ("build", "fleet", "recordings")}


def main(version, folder):
    files = sorted(Path(folder).glob("etlc*"))
    (wheel,) = (file for file in files if file.suffix == ".whl")
    within, tools = in_wheel(wheel), built_with()
    packages = [debian(name) for name in sorted(within | tools)]
    identity = {package["name"]: package["SPDXID"] for package in packages}
    sums = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
    for number, (name, checksum) in enumerate(sums.items()):
        packages.append({
            "SPDXID": f"SPDXRef-etlc-{number}",
            "name": "etlc",
            "versionInfo": version,
            "packageFileName": name,
            "checksums": [{"algorithm": "SHA256", "checksumValue": checksum}],
            "licenseDeclared": "MIT",
            "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False,
        })  # fmt: skip
        identity[name] = f"SPDXRef-etlc-{number}"

    def related(one, kind, other):
        return {
            "spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other,
        }  # fmt: skip

    relations = [related("SPDXRef-DOCUMENT", "DESCRIBES", identity[name]) for name in sums]
    relations += [
        related(identity[wheel.name], "CONTAINS", identity[name]) for name in sorted(within)
    ]
    relations += [
        related(identity[name], "BUILD_DEPENDENCY_OF", identity[file])
        for file in sums if file.endswith((".whl", ".deb")) for name in sorted(tools)
    ]  # fmt: skip
    digest = hashlib.sha256("".join(sums.values()).encode()).hexdigest()
    epoch = int(os.environ["SOURCE_DATE_EPOCH"])
    document = {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"etlc-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/etlc-{version}-{digest}",
        "creationInfo": {
            "created": datetime.fromtimestamp(epoch, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "creators": [f"Tool: etlc-{version}/cmake/sbom.py"],
        },
        "packages": packages,
        "relationships": relations,
    }
    print(json.dumps(document, indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:])
