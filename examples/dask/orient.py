"""orient.py SCHEDULER MODEL... -- [OPTION of cusp orient]..."""
import subprocess, sys, tempfile
from pathlib import Path
from distributed import Client, as_completed

SHARDS = 8  # of each model

def measure(name, model, files, options, shard):
    with tempfile.TemporaryDirectory() as folder:
        for file, content in {**files, name: model}.items():
            Path(folder, file).write_bytes(content)
        command = ["cusp", "orient", *options, f"--shard={shard}/{SHARDS}", "--", name]
        done = subprocess.run(command, cwd=folder, capture_output=True)
    if done.returncode < 0:  # perhaps for lack of memory: Dask tries again
        raise ChildProcessError(f"{name}: cusp was killed")
    return done.stdout, done.stderr.decode() if done.returncode else ""

split = sys.argv.index("--")
(scheduler, *models), options = sys.argv[1:split], sys.argv[split + 1 :]
named = {option.split("=")[-1] for option in options}
files = {path.name: path.read_bytes() for path in Path().iterdir() if path.name in named and path.is_file()}
# A model given twice is measured once. What is no file is reported when the parts are merged.
contents = {Path(model).read_bytes(): Path(model).name for model in models if Path(model).is_file()}
tasks, parts, reasons = [], [], set()
with tempfile.TemporaryDirectory() as folder, Client(scheduler) as client:
    for content, name in contents.items():
        sent = client.submit(bytes, content)  # a task, so that Dask sends it again if its worker is lost
        tasks += [client.submit(measure, name, sent, files, options, i, retries=2) for i in range(1, SHARDS + 1)]
    for task in as_completed(tasks):
        try:
            part, reason = task.result()
        except Exception as error:
            part, reason = b"", f"{error}\n"
        parts.append(part)
        reasons.add(reason)
    Path(folder, "parts").write_bytes(b"".join(parts))
    merged = subprocess.run(["cusp", "orient", *options, f"--merge={folder}/parts", "--", *models])
print(*sorted(reasons), sep="", end="", file=sys.stderr)  # why parts are missing
sys.exit(merged.returncode)
