"""A few source files in a folder of their own, for a test of a check."""
import contextlib
import pathlib
import tempfile


@contextlib.contextmanager
def small_tree(files):
    """The folder with these files, path to text; it is gone behind the with."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        yield root
