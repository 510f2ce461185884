"""What the peers of 'exemplar label' have in common, diffusion_net.py and tree_cascade.py.

They learn from the training meshes of an 'exemplar label evaluate', label its test meshes, and write what its --peer reads."""

import argparse
import json
import pathlib
import subprocess
import sys
import time

from surfaces import DataError, labels_path, read_text, write_atomically

REPORT_SECONDS = 20


class Split:
    """The training and the test meshes of a category. 'name' is that of the folder with the results of the split."""

    def __init__(self, category, name, train, test):
        self.category, self.name, self.train, self.test = category, name, train, test


def read_splits(path, number, only):
    """Returns a split of each category of a report of 'exemplar label evaluate'."""
    try:
        categories = json.loads(read_text(path))["categories"]
        known = {category["category"]: category["splits"] for category in categories}
        for name in only:
            if name not in known:
                raise DataError(path, f"has no category {name}; it has {', '.join(known)}")
        for name, splits in known.items():
            if not number < len(splits):
                raise DataError(path, f"has no split {number} of {name}; it has {len(splits)}")
        return [split_of(path, name, splits[number]) for name, splits in known.items() if name in only or not only]
    except json.JSONDecodeError:
        raise DataError(path, "is not JSON") from None
    except (KeyError, TypeError, AttributeError):
        raise DataError(path, "is not a report of 'exemplar label evaluate'") from None


def split_of(report, category, split):
    test = [pathlib.Path(mesh["path"]) for mesh in split["meshes"]]
    if not test or not split["train"]:
        raise DataError(report, f"has no training or no test meshes of {category}")
    return Split(category, split["split"], [test[0].with_name(name + test[0].suffix) for name in split["train"]], test)


class Labels:
    """The folder of the labels of a category. Labels with other settings are refused."""

    def __init__(self, split, out, settings):
        self.folder = out / split.category
        self.test = split.test
        self.settings = settings | {"train": [path.stem for path in split.train], "test": [path.stem for path in split.test]}

    def path(self, mesh):
        return self.folder / labels_path(mesh).name

    def are_complete(self):
        """Says whether an earlier call wrote them all; raises DataError if it did so with other options."""
        record = self.folder / "training.json"
        if not record.exists():
            return False
        try:
            settings = json.loads(read_text(record))["settings"]
        except (ValueError, KeyError, TypeError):
            raise DataError(record, "cannot be read; remove it") from None
        if settings != self.settings:
            raise DataError(record, "these labels were learned with other options or from other meshes; choose another --out")
        return all(self.path(mesh).exists() for mesh in self.test)

    def complete(self, record):
        """Writes how the labels were learned, after the last of them."""
        write_atomically(self.folder / "training.json",
                         lambda file: json.dump({"settings": self.settings} | record, file, indent=1))


class Progress:
    """Prints where the work is and the time left, if all categories take as long as those before."""

    def __init__(self, categories):
        self.categories, self.done, self.start, self.printed = categories, 0, time.monotonic(), time.monotonic()

    def say(self, text, share=0.0):
        done = (self.done + share) / self.categories
        spent = time.monotonic() - self.start
        left = f", {spent * (1 - done) / done / 60:.1f} min left" if 0 < done < 1 else ""
        print(f"{text}{left}", file=sys.stderr, flush=True)
        self.printed = time.monotonic()

    def is_due(self):
        return time.monotonic() - self.printed > REPORT_SECONDS


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return number


def parser(description):
    """Returns a parser of the options that all peers have."""
    result = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("report", type=pathlib.Path, metavar="REPORT.json", help="of 'exemplar label evaluate'")
    result.add_argument("--out", type=pathlib.Path, required=True, metavar="FOLDER", help="for the labels")
    result.add_argument("--split", type=int, default=0, help="number of the split, from 0")
    result.add_argument("--category", nargs="+", default=[], metavar="NAME", help="only these")
    result.add_argument("--seed", type=int, default=1, help="of all random choices")
    return result


def parse(parser, arguments):
    options = parser.parse_args(arguments)
    if not 0 <= options.seed < 2 ** 32 or options.split < 0:
        parser.error("--seed must be below 2^32, and neither it nor --split negative")
    return options


def label_all(options, is_labeled, label):
    """Calls label(split, progress) for each category for which is_labeled(split) is false. Errors end the program: one line."""
    try:
        splits = read_splits(options.report, options.split, options.category)
        missing = [split for split in splits if not is_labeled(split)]
        progress = Progress(len(missing))
        for split in missing:
            label(split, progress)
            progress.done += 1
        print(f"labeled now: {len(missing)} of {len(splits)} categories; the others were there", file=sys.stderr)
    except DataError as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        sys.exit(f"error: {error.filename}: {error.strerror}")
    except subprocess.CalledProcessError:
        sys.exit(1)  # the program that was called has said why
    except KeyboardInterrupt:
        sys.exit(130)
