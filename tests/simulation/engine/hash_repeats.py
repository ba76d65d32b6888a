"""Runs the same 60 s twice, in two processes, and compares the state hashes."""
import json
import subprocess
import sys

COMMAND = [sys.argv[1], "gait", "--gait", "run", "--speed", "2", "--turn", "5", "--seconds", "60",
           "--trials", "1", "--seed", "7", "--json"]
hashes = {json.loads(subprocess.run(COMMAND, check=True, capture_output=True).stdout)["state_hash"]
          for _ in range(2)}
sys.exit(0 if len(hashes) == 1 else f"two runs ended in different states: {sorted(hashes)}")
