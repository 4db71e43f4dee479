#!/usr/bin/env python3
"""Makes a wheel that any Linux of this C library or a later one can use: `portable_wheel.py WHEEL [FOLDER]`.

As auditwheel does it, which Debian 12 does not have: shared libraries that not every system has (PEP 600) go into the wheel, under names of
their own, so that they meet no others in the process; the tag says which version of the C library is needed. It needs patchelf.
"""

import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

# What a wheel may take from the system (policies of auditwheel for manylinux).
OF_THE_SYSTEM = re.compile(
    r"^(linux-vdso|ld-linux[-\w]*|libc|libm|libdl|librt|libpthread|libresolv|libutil|libnsl|libanl|libgcc_s|libstdc\+\+|libz)\.so(\.|$)"
)
# The first version of the C library whose policy has this version of the C++ library.
GLIBC_OF_GLIBCXX = [((3, 4, 30), (2, 35)), ((3, 4, 29), (2, 34)), ((3, 4, 26), (2, 31)), ((3, 4, 24), (2, 27))]
NEWEST_GLIBCXX = (3, 4, 30)


def said(*words: object) -> str:
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def needed_by(file: pathlib.Path) -> dict[str, pathlib.Path]:
    """Libraries of the whole tree of needs, by name, that the system need not have."""
    found = {}
    for line in said("ldd", file).splitlines():
        if "not found" in line:
            raise SystemExit(f"{file}: {line.strip()}")
        if match := re.match(r"\s*(\S+) => (\S+) \(", line):
            if not OF_THE_SYSTEM.match(match[1]):
                found[match[1]] = pathlib.Path(match[2]).resolve()
    return found


def versions(file: pathlib.Path, of: str) -> list[tuple[int, ...]]:
    return [tuple(map(int, match.split("."))) for match in re.findall(rf"\b{of}_([0-9.]+)\b", said("objdump", "-T", file))]


def needed_glibc(files: list[pathlib.Path]) -> tuple[int, ...]:
    needed = max((version for file in files for version in versions(file, "GLIBC")), default=(2, 17))
    cxx = max((version for file in files for version in versions(file, "GLIBCXX")), default=(3, 4))
    if cxx > NEWEST_GLIBCXX:
        raise SystemExit(f"GLIBCXX_{'.'.join(map(str, cxx))} is newer than what is known here")
    return max([needed[:2], *(glibc for least, glibc in GLIBC_OF_GLIBCXX if cxx >= least)])


def bundle(module: pathlib.Path, into: pathlib.Path) -> list[pathlib.Path]:
    """Copies what the module needs, and makes both find it there."""
    libraries = needed_by(module)
    names = {}
    into.mkdir()
    for name, source in libraries.items():
        stem, dot, rest = name.partition(".so")
        names[name] = f"{stem}-{hashlib.sha256(source.read_bytes()).hexdigest()[:8]}{dot}{rest}"
        shutil.copyfile(source, into / names[name])
        (into / names[name]).chmod(0o755)

    def rename(file: pathlib.Path, path: str) -> None:
        # One change at a time: several at once end in files that cannot be loaded (patchelf 0.14).
        for needed in said("patchelf", "--print-needed", file).split():
            if needed in names:
                said("patchelf", "--replace-needed", needed, names[needed], file)
        said("patchelf", "--set-rpath", path, file)

    for name in names.values():
        said("patchelf", "--set-soname", name, into / name)
        rename(into / name, "$ORIGIN")
    rename(module, f"$ORIGIN/../{into.name}")
    return [module, *(into / name for name in names.values())]


def write_record(folder: pathlib.Path, info: pathlib.Path) -> None:
    lines = []
    for file in sorted(path for path in folder.rglob("*") if path.is_file() and path != info / "RECORD"):
        digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest()).rstrip(b"=").decode()
        lines.append(f"{file.relative_to(folder)},sha256={digest},{file.stat().st_size}\n")
    (info / "RECORD").write_text("".join(lines) + f"{(info / 'RECORD').relative_to(folder)},,\n")


def make_portable(wheel: pathlib.Path, to: pathlib.Path) -> pathlib.Path:
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        with zipfile.ZipFile(wheel) as packed:
            packed.extractall(folder)
        (module,) = folder.glob("*/_core*.so")
        (info,) = folder.glob("*.dist-info")
        glibc = needed_glibc(bundle(module, folder / f"{module.parent.name}.libs"))
        old = wheel.stem.rpartition("-")[2]
        tag = f"manylinux_{glibc[0]}_{glibc[1]}_{old.partition('_')[2]}"
        words = (info / "WHEEL").read_text()
        (info / "WHEEL").write_text(words.replace(f"-{old}\n", f"-{tag}\n"))
        write_record(folder, info)
        made = to / f"{wheel.stem.removesuffix(old)}{tag}.whl"
        with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as packed:
            for file in sorted(path for path in folder.rglob("*") if path.is_file()):
                packed.write(file, file.relative_to(folder))
    return made


def main() -> int:
    if not 2 <= len(sys.argv) <= 3:
        print(__doc__, file=sys.stderr)
        return 2
    wheel = pathlib.Path(sys.argv[1])
    print(make_portable(wheel, pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else wheel.parent))
    return 0


if __name__ == "__main__":
    sys.exit(main())
