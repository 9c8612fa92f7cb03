#!/usr/bin/env python3
"""compare.py BEFORE.json AFTER.json: compares two saved results of a bench, row by row: every
figure before and after, and their ratio.

A result is a list of rows; a row is an object with one text, its name, and figures. The exit
status is 1 if the files have no row in common.
"""
import json
import sys


def rows(path):
    with open(path, encoding="utf-8") as file:
        return {next(v for v in row.values() if isinstance(v, str)): row for row in json.load(file)}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    before, after = rows(sys.argv[1]), rows(sys.argv[2])
    if not before.keys() & after.keys():
        sys.exit("no row is in both")
    for name, row in after.items():
        print(name)
        for figure, value in row.items():
            was = before.get(name, {}).get(figure)
            if isinstance(value, str) or not isinstance(was, (int, float)):
                continue
            ratio = f"{value / was:8.2f}" if was else "       -"
            print(f"  {figure:24} {was:14.2f} {value:14.2f} {ratio}")


main()
