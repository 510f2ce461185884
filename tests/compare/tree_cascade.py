#!/usr/bin/env python3
"""Labels the test meshes of 'exemplar label evaluate' by XGBoost in a cascade, trained on the same meshes, for its --peer.

    exemplar label evaluate --protocol sb6 psb/labeled --out out/sb6
    tests/compare/tree_cascade.py out/sb6/report.json --models out/sb6 --out peers/xgboost
    exemplar label evaluate --protocol sb6 psb/labeled --out out/sb6 --peer peers/xgboost

Boosted trees take the place of boosted stumps; features, context and graph cut are those of 'exemplar label':
- Classifiers learn from up to 4,000 faces of each training mesh, drawn at random. All meshes weigh the same, and each label as
  the square root of its area.
- Meshes are dealt to at most five folds. A stage has a classifier for each fold, trained without it, and one of all meshes. The
  probabilities of a training mesh are those of the classifier that has not seen it, those of a test mesh the mean of all.
- A stage after the first also sees histograms of the labels around each face, by the probabilities of the stage before it. As in
  'exemplar label', it is dropped if the loss of held-out meshes is more than 5 % above that of the stage before.
- The depth and the number of the trees are chosen once per category, by the loss of held-out meshes in the first stage.
- The boundary classifier and the weights of the graph cut are those of Exemplar's model of the split, below --models. They were
  learned for Exemplar's probabilities, not for these.

It takes about four minutes for a category of six training meshes.

OUT/CATEGORY/NAME_labels.txt are the labels, OUT_uncut/CATEGORY/NAME_labels.txt those before the cut; training.json beside them
says how they were learned. What is there already is not learned again. Equal options give equal files. Needs XGBoost and SciPy
(Debian: python3-xgboost, python3-scipy)."""

import os

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")  # before numpy; XGBoost has threads of its own

import hashlib
import json
import pathlib
import struct
import subprocess
import tempfile
import time
import typing

import numpy
import xgboost

import peer
import programs
from peer import Labels, positive
from surfaces import DataError, face_areas, labels_path, read_labels, read_off, write_labels

ROWS = 4000                # of a training mesh
MOST_FOLDS = 5
DEPTHS, ROUNDS = (3, 4, 6), (50, 100)
SETTINGS = {"objective": "multi:softprob", "tree_method": "hist", "max_bin": 64, "eta": 0.1, "subsample": 0.5,
            "colsample_bynode": 0.1}
LEAST_PROBABILITY = 1e-6   # in logarithms
MOST_LOSS_RATIO = 1.05     # of a stage, to that of the stage before


class Mesh:
    """A mesh and what the cascade knows of its faces."""

    def __init__(self, path, features):
        self.path = path
        self.features = numpy.load(features, mmap_mode="r")  # faces x features
        self.probabilities = None                            # faces x labels, by the last stage

    def columns(self, options):
        """Returns the features, and after the first stage context behind them."""
        if self.probabilities is None:
            return self.features
        name, classes = self.path.stem, self.probabilities.shape[1]
        context = programs.run("compare_faces", ["context", options.cache, classes], {name: self.probabilities},
                               scratch=options.work, behind=[self.path])[0]
        return numpy.hstack([self.features, context[name]])


class Rows:
    """The faces of the training meshes that classifiers learn from, and the label, weight and fold of each.

    'targets' are arrays per mesh: the number of the label of each face, -1 for none; 'areas' are those of the faces."""

    def __init__(self, targets, areas, classes, seed):
        random = numpy.random.RandomState(seed)
        meshes = len(targets)
        self.folds = min(meshes, MOST_FOLDS)
        self.fold_of_mesh = random.permutation(meshes) % self.folds
        usable = [numpy.flatnonzero((target >= 0) & (area > 0)) for target, area in zip(targets, areas)]
        self.faces = [numpy.sort(random.permutation(faces)[:ROWS]) for faces in usable]
        self.label = self.of(targets)
        self.fold = numpy.repeat(self.fold_of_mesh, [len(faces) for faces in self.faces])
        share = numpy.concatenate([area[faces] / area[faces].sum() for area, faces in zip(areas, self.faces)])
        self.weight = share / numpy.sqrt(numpy.bincount(self.label, share, classes)[self.label])
        self.weight *= len(self.weight) / self.weight.sum()

    def of(self, per_mesh):
        """Returns the values of the rows from those of all faces of each mesh."""
        return numpy.concatenate([values[faces] for values, faces in zip(per_mesh, self.faces)])

    def loss(self, probabilities):
        """Returns the mean log loss of the rows. A label that only one fold has cannot be learned for it, and does not count."""
        counts = numpy.array([numpy.bincount(self.label[self.fold == fold], minlength=probabilities.shape[1]) > 0
                              for fold in range(self.folds)]).sum(axis=0)
        weight = self.weight * (counts[self.label] > 1)
        of_truth = numpy.maximum(probabilities[numpy.arange(len(self.label)), self.label], LEAST_PROBABILITY)
        return float(-(weight @ numpy.log(of_truth)) / max(weight.sum(), 1e-12))


class Trees(typing.NamedTuple):
    """Parameters of a classifier."""

    depth: int
    rounds: int


class Trainer:
    """Trains classifiers of rows, and counts them."""

    def __init__(self, rows, classes, options, trained):
        self.rows, self.trained = rows, trained
        self.settings = SETTINGS | {"num_class": classes, "seed": options.seed, "nthread": options.threads, "verbosity": 1}

    def matrix(self, x, seen):
        """Returns the rows of x, of which only some are seen, as XGBoost takes them."""
        return xgboost.QuantileDMatrix(x[seen], self.rows.label[seen], weight=self.rows.weight[seen],
                                       max_bin=self.settings["max_bin"], nthread=self.settings["nthread"])

    def classifier(self, matrix, trees):
        result = xgboost.train(self.settings | {"max_depth": trees.depth}, matrix, trees.rounds)
        self.trained()
        return result

    def of_folds(self, x, trees):
        """Returns a classifier for each fold, trained without it."""
        return [self.classifier(self.matrix(x, self.rows.fold != fold), trees) for fold in range(self.rows.folds)]

    def of_all(self, x, trees):
        return self.classifier(self.matrix(x, numpy.full(len(x), True)), trees)

    def chosen(self, x):
        """Returns the parameters of the least held-out loss, and the classifiers of the folds with these."""
        grid = [Trees(depth, rounds) for depth in DEPTHS for rounds in ROUNDS]
        held_out = {trees: numpy.zeros((len(x), self.settings["num_class"])) for trees in grid}
        boosted = {depth: [] for depth in DEPTHS}
        for fold in range(self.rows.folds):
            unseen = self.rows.fold == fold
            matrix = self.matrix(x, ~unseen)
            for depth in DEPTHS:
                classifier = self.classifier(matrix, Trees(depth, max(ROUNDS)))
                boosted[depth].append(classifier)
                for rounds in ROUNDS:
                    held_out[depth, rounds][unseen] = classifier.inplace_predict(x[unseen], iteration_range=(0, rounds))
        trees = min(grid, key=lambda tried: self.rows.loss(held_out[tried]))
        return trees, [classifier[:trees.rounds] for classifier in boosted[trees.depth]]


def run_cascade(train, test, rows, trainer, options):
    """Gives all meshes their probabilities; returns the parameters of the trees and the held-out loss of each stage."""
    trees, losses = None, []
    for stage in range(options.stages):
        columns = [mesh.columns(options) for mesh in train]
        x = rows.of(columns)
        if stage == 0:
            trees, of_folds = trainer.chosen(x)
        else:
            of_folds = trainer.of_folds(x, trees)
        held_out = [of_folds[fold].inplace_predict(of_mesh) for fold, of_mesh in zip(rows.fold_of_mesh, columns)]
        losses.append(rows.loss(rows.of(held_out)))
        if stage > 0 and losses[-1] > MOST_LOSS_RATIO * losses[-2]:
            break
        classifiers = [*of_folds, trainer.of_all(x, trees)]
        for mesh in test:
            of_mesh = mesh.columns(options)
            mesh.probabilities = numpy.mean([classifier.inplace_predict(of_mesh) for classifier in classifiers], axis=0)
        for mesh, probabilities in zip(train, held_out):
            mesh.probabilities = probabilities
    return trees, losses


def cut_labels(model, meshes, options):
    """Returns the number of the label of each face of each mesh, after the graph cut of a model of 'exemplar label'."""
    given = {f"{mesh.path.stem}/trees": mesh.probabilities for mesh in meshes}
    found = programs.run("compare_faces", ["cut", options.cache, model], given, scratch=options.work,
                         behind=[mesh.path for mesh in meshes])[0]
    return [found[f"{mesh.path.stem}/trees"] for mesh in meshes]


def read_label_names(path, split):
    """Returns the names of the labels of a model, in its order; raises DataError if it was not trained on these meshes."""
    content = path.read_bytes()
    try:
        size = struct.unpack("<Q", content[:8])[0]
        model = json.loads(json.loads(content[8:8 + size])["__metadata__"]["model"])
        names, trained_on = list(model["labels"]), {line.rsplit(" ", 1)[0] for line in model["provenance"]}
    except (ValueError, KeyError, TypeError, AttributeError, struct.error):
        raise DataError(path, "not a model of 'exemplar label'") from None
    if trained_on != {mesh.stem for mesh in split.train}:
        raise DataError(path, "was trained on other meshes than those of the report")
    return names


def read_targets(split, names):
    """Returns the areas of the faces of each training mesh, and the numbers of their labels, -1 for none."""
    areas = [face_areas(*read_off(path)) for path in split.train]
    number = {"": -1} | {name: n for n, name in enumerate(names)}
    targets = []
    for path, area in zip(split.train, areas):
        labels = read_labels(labels_path(path), len(area))
        if unknown := set(labels) - set(number):
            raise DataError(labels_path(path), f"has the label {min(unknown)}, which Exemplar's model lacks")
        targets.append(numpy.array([number[name] for name in labels]))
        if not (area[targets[-1] >= 0] > 0).any():
            raise DataError(labels_path(path), "labels no surface")
    return areas, targets


def read_meshes(paths, cache, folder):
    """Computes the features of meshes, into a folder, unless the cache has them."""
    subprocess.run([programs.program("compare_faces"), "features", cache, folder, *paths], check=True)
    return [Mesh(path, folder / f"{path.stem}.npy") for path in paths]


def model_of(split, options):
    return options.models / split.category / split.name / "model.safetensors"


def labels_of(split, options):
    """Returns the folders of the labels, after and before the cut."""
    settings = {"stages": options.stages, "seed": options.seed,
                "model": hashlib.sha256(model_of(split, options).read_bytes()).hexdigest()[:16]}
    return [Labels(split, out, settings) for out in (options.out, options.out.with_name(options.out.name + "_uncut"))]


def progress_of_training(category, classifiers, progress):
    """Returns a function to call whenever one of so many classifiers is trained."""
    trained = 0

    def count():
        nonlocal trained
        trained += 1
        if progress.is_due():
            progress.say(f"{category}: {trained} of {classifiers} classifiers are trained", trained / classifiers)
    return count


def label_category(split, options, progress):
    start = time.monotonic()
    if len(split.train) < 2:
        raise DataError(options.report, f"has one training mesh of {split.category}; held-out probabilities need two")
    progress.say(f"{split.category}: {len(split.train)} training meshes, {len(split.test)} test meshes")
    names = read_label_names(model_of(split, options), split)
    areas, targets = read_targets(split, names)
    rows = Rows(targets, areas, len(names), options.seed)
    classifiers = len(DEPTHS) * rows.folds + 1 + (options.stages - 1) * (rows.folds + 1)
    trainer = Trainer(rows, len(names), options, progress_of_training(split.category, classifiers, progress))
    with tempfile.TemporaryDirectory(prefix="exemplar-compare-", dir=options.work) as folder:
        train, test = (read_meshes(paths, options.cache, pathlib.Path(folder)) for paths in (split.train, split.test))
        trees, losses = run_cascade(train, test, rows, trainer, options)
    after, before = labels_of(split, options)
    names = numpy.array(names, dtype=object)
    for mesh, cut in zip(test, cut_labels(model_of(split, options), test, options)):
        write_labels(before.path(mesh.path), names[mesh.probabilities.argmax(axis=1)])
        write_labels(after.path(mesh.path), names[cut])
    seconds = time.monotonic() - start
    for labels in (before, after):
        labels.complete({"trees": trees._asdict(), "loss": [round(loss, 4) for loss in losses], "seconds": round(seconds, 1)})
    of_stages = ", ".join(f"{loss:.3f}" for loss in losses)
    progress.say(f"{split.category}: labeled, {seconds:.0f} s, held-out loss of the stages {of_stages}", 1)


def default_cache():
    """Returns the folder in which 'exemplar label' remembers features unless told otherwise."""
    folder = os.environ.get("XDG_CACHE_HOME")
    return (pathlib.Path(folder) if folder else pathlib.Path.home() / ".cache") / "exemplar" / "features"


def parse(arguments):
    parser = peer.parser(__doc__)
    parser.add_argument("--models", type=pathlib.Path, required=True, metavar="FOLDER", help="the --out of the evaluation")
    parser.add_argument("--stages", type=positive, default=3, help="most classifiers of the cascade")
    parser.add_argument("--threads", type=positive, default=1, help="of XGBoost")
    parser.add_argument("--cache", default=str(default_cache()), metavar="FOLDER",
                        help="remembers features; that of 'exemplar label' unless given")
    parser.add_argument("--work", type=pathlib.Path, metavar="FOLDER",
                        help="for features, 40 to 80 MB a mesh, until they are used; the system's temporary folder unless given")
    options = peer.parse(parser, arguments)
    options.out = options.out.resolve()
    return options


def main(arguments=None):
    options = parse(arguments)
    peer.label_all(options, lambda split: all(labels.are_complete() for labels in labels_of(split, options)),
                   lambda split, progress: label_category(split, options, progress))


if __name__ == "__main__":
    main()
