"""slice.py SCHEDULER FOLDER -- [OPTION of cusp slice]..."""
import subprocess, sys, tempfile
from pathlib import Path
from distributed import Client, as_completed

def slice_model(name, model, files, options):
    with tempfile.TemporaryDirectory() as folder:
        for file, content in {**files, name: model}.items():
            Path(folder, file).write_bytes(content)
        Path(folder, "prints").mkdir()
        command = ["cusp", "slice", *options, "-o", "prints/", "--", name]
        done = subprocess.run(command, cwd=folder, capture_output=True)
        if done.returncode < 0:  # perhaps for lack of memory: Dask tries again
            raise ChildProcessError(f"{name}: cusp was killed")
        made = {path.name: path.read_bytes() for path in Path(folder).glob("prints/*")}
    return made, done.stdout.decode(), done.stderr.decode()

_, scheduler, folder, _, *options = sys.argv
named = {option.split("=")[-1] for option in options}
files = {path.name: path.read_bytes() for path in Path().iterdir() if path.name in named and path.is_file()}
models = [path for path in Path(folder).iterdir() if path.suffix.lower() in {".stl", ".3mf", ".obj"}]
if len({model.stem.lower() for model in models}) < len(models):
    sys.exit("two models would have the same print file")
Path("prints").mkdir(exist_ok=True)
failed = []
with Client(scheduler) as client:
    tasks = [client.submit(slice_model, model.name, model.read_bytes(), files, options, retries=2) for model in models]
    for task in as_completed(tasks):
        tasks.remove(task)  # so that Dask forgets its print file
        try:
            made, line, said = task.result()
        except Exception as error:
            made, line, said = {}, "", f"{error}\n"
        for name, content in made.items():
            Path("prints", f"{name}.new").write_bytes(content)
            Path("prints", f"{name}.new").replace(Path("prints", name))
        print(line, end="", flush=True)
        sys.stderr.write(said)
        if not made:
            failed.append(said)
if failed:
    sys.exit(f"{len(failed)} of {len(models)} models failed:\n" + "".join(sorted(failed)).rstrip())
