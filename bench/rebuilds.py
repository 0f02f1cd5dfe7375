"""Prints which crates of the workspace are compiled again when one of them is touched: `make rebuilds`.

Asks `cargo metadata` for what each crate is built on, tests left out.
"""

import json
import subprocess

metadata = json.loads(
    subprocess.run(
        ["cargo", "metadata", "--format-version", "1", "--no-deps", "--locked"], check=True, capture_output=True
    ).stdout
)
packages = {package["name"]: package for package in metadata["packages"]}
built_on = {
    name: {d["name"] for d in package["dependencies"] if d["kind"] != "dev" and d["name"] in packages}
    for name, package in packages.items()
}


def rebuilt(touched: str) -> set[str]:
    """Every crate that is built on the touched one, directly or through others."""
    found: set[str] = set()
    while True:
        more = {name for name, on in built_on.items() if name not in found and on & (found | {touched})}
        if not more:
            return found
        found |= more


print("| touched | compiled again |\n|---|---|")
for name in sorted(packages, key=lambda name: (-len(rebuilt(name)), name)):
    others = sorted(rebuilt(name), key=lambda other: (-len(rebuilt(other)), other))
    print(f"| `{name}` | {', '.join(f'`{other}`' for other in others) or 'nothing else'} |")
