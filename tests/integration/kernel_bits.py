"""Kernels compiled for registers of any size give the same bits: the programs in KERNEL_BITS print the same."""

import os
import signal
import subprocess
import sys

outputs = {}
for program in os.environ["KERNEL_BITS"].split(":"):
    result = subprocess.run([program], capture_output=True, text=True, check=False)
    if result.returncode == -signal.SIGILL:
        print(f"{program}: this processor lacks its instructions")
        continue
    if result.returncode != 0:
        sys.exit(f"{program}: exit code {result.returncode}\n{result.stderr}")
    outputs[program] = result.stdout

first, *others = outputs
if not others:
    sys.exit(77)
if len(outputs[first].splitlines()) != 18 or "not positive" in outputs[first]:
    sys.exit(f"{first} printed\n{outputs[first]}")
for other in others:
    if outputs[other] != outputs[first]:
        sys.exit(f"{first}:\n{outputs[first]}\n{other}:\n{outputs[other]}")
