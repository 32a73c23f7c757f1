"""Writes what is inside the packaged program: a CycloneDX bill of materials and the licence texts, from `cargo metadata`.

materials.py VERSION FOLDER TREE < the output of `cargo metadata`; TREE is a file with the lines of `cargo tree --prefix none`
"""

import json
import re
import sys
from pathlib import Path

LICENCE_FILE = re.compile(r"^(licen[cs]e|copying|notice|unlicense|ofl)", re.IGNORECASE)


def inside(metadata: dict, tree: str) -> list[dict]:
    """The packages that `cargo tree` names: what is in the program, not what builds or tests it."""
    named = {tuple(line.split()[:2]) for line in tree.splitlines() if line.strip()}
    found = [package for package in metadata["packages"] if (package["name"], f"v{package['version']}") in named]
    if len(found) != len(named):
        sys.exit(f"{len(named)} packages are named, {len(found)} are described")
    return sorted(found, key=lambda package: (package["name"], package["version"]))


def component(package: dict) -> dict:
    """A package as CycloneDX has it."""
    identity = f"{package['name']}@{package['version']}"
    of_crates = (package["source"] or "").startswith("registry+")
    entry = {
        "type": "library",
        "bom-ref": identity,
        "name": package["name"],
        "version": package["version"],
        "licenses": [{"expression": expression(package["license"])}],
    }
    if of_crates:
        entry["purl"] = f"pkg:cargo/{identity}"
    return entry


def expression(text: str) -> str:
    """An SPDX expression: older crates write "MIT/Apache-2.0"."""
    return text.replace("/", " OR ")


def texts(package: dict) -> list[Path]:
    """Its licence files, and those of fonts that it brings."""
    folder = Path(package["manifest_path"]).parent
    fonts = (folder / "fonts").glob("*.txt")
    return sorted([*(path for path in folder.iterdir() if path.is_file() and LICENCE_FILE.match(path.name)), *fonts])


def main() -> None:
    version, folder = sys.argv[1], Path(sys.argv[2])
    metadata = json.load(sys.stdin)
    packages = inside(metadata, Path(sys.argv[3]).read_text(encoding="utf-8"))
    without = [package["name"] for package in packages if not package["license"]]
    if without:
        sys.exit(f"no licence is named by: {', '.join(without)}")
    bill = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application", "bom-ref": "brushwork", "name": "brushwork", "version": version}},
        "components": [component(package) for package in packages],
    }
    (folder / f"brushwork-{version}.cdx.json").write_text(json.dumps(bill, indent=1) + "\n", encoding="utf-8")
    # The same text stands once, under the names of all that have it.
    owners: dict[str, list[str]] = {}
    for package in packages:
        if package["source"] is None:
            continue
        for path in texts(package):
            owners.setdefault(path.read_text(encoding="utf-8", errors="replace").strip(), []).append(f"{package['name']} {package['version']}")
    lines = [f"What Brushwork {version} is made of, and under which licences.\n"]
    lines += [f"{package['name']} {package['version']}: {expression(package['license'])}" for package in packages]
    for text, names in sorted(owners.items(), key=lambda item: item[1]):
        lines += ["", "=" * 80, ", ".join(sorted(set(names))), "=" * 80, "", text]
    (folder / f"brushwork-{version}-licences.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"{len(packages)} packages, {len(owners)} licence texts")


if __name__ == "__main__":
    main()
