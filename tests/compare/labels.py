#!/usr/bin/env python3
"""Compares classifiers of faces with Exemplar's JointBoost on the same features (thesis Fig. 2.4).

    tests/compare/labels.py --work FOLDER                            # generated shapes
    EXEMPLAR_DATA=psb tests/compare/labels.py --work FOLDER --cut    # the Princeton Segmentation Benchmark

Every learner gets the same faces of six training meshes of a category, with the same features and weights, and says which
label each face of four unseen meshes has. Parameters are chosen by leaving out two training meshes at a time, by the share
of the surface that is labeled wrong. Printed are, per category, the share of the surface of the unseen meshes that is
labeled wrong, in percent, mean over meshes, before any graph cut; with --cut also after the cut of the model that 'exemplar
label train' learns from these meshes. Times are seconds of one thread. FOLDER keeps features and results for the next call. Needs
scikit-learn and XGBoost (Debian: python3-sklearn, python3-xgboost), for the picture matplotlib (python3-matplotlib)."""

import os

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")  # before numpy: all learners have one thread

import argparse
import json
import pathlib
import subprocess
import sys
import time
import warnings

import numpy
from scipy.linalg import LinAlgWarning
from sklearn.exceptions import ConvergenceWarning
from sklearn.model_selection import ParameterGrid

import programs
from learners import PEERS, Known, as_scores

# The training meshes that docs/results/labeling.md lists; every fourth of the other fourteen is tested on.
TRAINING = {
    "Human": (3, 5, 9, 10, 13, 15), "Cup": (27, 32, 34, 35, 38, 40), "Glasses": (41, 43, 50, 51, 58, 60),
    "Ant": (84, 88, 89, 91, 96, 100), "Octopus": (125, 127, 133, 134, 135, 140), "Table": (145, 146, 148, 154, 158, 160),
    "Teddy": (162, 164, 168, 171, 177, 179), "Fish": (221, 228, 235, 237, 238, 240), "Bust": (306, 309, 310, 314, 316, 319),
    "Bearing": (346, 352, 353, 355, 356, 357), "Vase": (363, 364, 365, 368, 369, 379),
    "FourLeg": (383, 384, 385, 388, 390, 391),
}
TESTED = 4
GENERATED = ("human", "fourleg", "cup", "chair", "table", "octopus", "glasses")
HELD_OUT_FOLDS, BOOSTING_FOLDS = 3, 5
CUT_ROWS = 3000
# One label in so many is taken to be noise when probabilities are judged.
NOISE = 0.01


class Mesh:
    """Label names and areas of the faces of a mesh, and their features."""

    def __init__(self, path, features):
        self.path = path
        self.area = face_areas(path)
        self.label = face_labels(path.with_name(path.stem + "_labels.txt"), len(self.area))
        self.features = numpy.load(features)


def face_areas(path):
    numbers = path.read_text().split()
    vertices, faces = int(numbers[1]), int(numbers[2])
    points = numpy.array(numbers[4:4 + 3 * vertices], float).reshape(-1, 3)
    corners = points[numpy.array(numbers[4 + 3 * vertices:4 + 3 * vertices + 4 * faces], int).reshape(-1, 4)[:, 1:]]
    return numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2


def face_labels(path, faces):
    """From pairs of lines: a name, then the 1-based numbers of its faces."""
    labels = numpy.full(faces, "", dtype=object)
    lines = [line.strip() for line in path.read_text().splitlines() if line.strip()]
    for name, numbers in zip(lines[::2], lines[1::2]):
        labels[numpy.array(numbers.split(), int) - 1] = name
    return labels


def scaled_to_one(weight):
    """Weights whose mean is one."""
    return weight * len(weight) / weight.sum()


class Category:
    """Training and test meshes, and the rows that are learned from."""

    def __init__(self, name, train, test, work, rows):
        self.name, self.train_paths, self.test_paths = name, train, test
        self.folder = work / name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.export([path for path in train + test if not self.features_of(path).exists()])
        self.test = [Mesh(path, self.features_of(path)) for path in test]
        self.collect([Mesh(path, self.features_of(path)) for path in train], rows)

    def results(self, cv_rows):
        """The folder of what was learned from so many rows."""
        return self.folder / f"results-{len(self.y)}-{cv_rows}"

    def features_of(self, path):
        return self.folder / f"{path.stem}.npy"

    def export(self, meshes):
        for mesh in meshes:
            subprocess.run([programs.program("compare_faces"), "features", self.folder.parent / "cache", self.folder, mesh],
                           check=True)

    def collect(self, meshes, rows):
        """Some faces of each mesh, drawn at random; x, y, weight, area and mesh of each."""
        self.labels = sorted({name for mesh in meshes for name in mesh.label} - {""})
        random = numpy.random.RandomState(1)
        chosen = [random.permutation(numpy.flatnonzero(mesh.label != ""))[:rows] for mesh in meshes]
        together = lambda values: numpy.concatenate([value[faces] for value, faces in zip(values, chosen)])
        self.x = together([mesh.features for mesh in meshes])
        self.y = numpy.searchsorted(self.labels, together([mesh.label for mesh in meshes]).astype(str))
        self.area = together([mesh.area / mesh.area.sum() for mesh in meshes])
        self.mesh = numpy.repeat(numpy.arange(len(meshes)), [len(faces) for faces in chosen])
        # As Exemplar weighs them: meshes count the same, and a label as the root of its area.
        share = numpy.bincount(self.y, self.area, len(self.labels))
        self.weight = scaled_to_one(self.area / numpy.sqrt(share[self.y]))
        self.equal_weight = scaled_to_one(self.area / share[self.y])

    def fold(self, folds):
        """Which fold holds a row out: all of a mesh together."""
        return self.mesh % folds

    def cv_rows(self, rows):
        """The first so many rows of each mesh; they are in random order."""
        return numpy.concatenate([numpy.flatnonzero(self.mesh == mesh)[:rows] for mesh in numpy.unique(self.mesh)])

    def wrong(self, mesh, label):
        """Share of the surface that is not labeled as the truth, and the mean over labels of the same."""
        right = numpy.array(self.labels, dtype=object)[label] == mesh.label
        parts = [mesh.label == name for name in set(mesh.label) - {""}]
        return (1 - mesh.area[right].sum() / mesh.area.sum(),
                1 - numpy.mean([mesh.area[right & part].sum() / mesh.area[part].sum() for part in parts]))


def benchmark_categories(names, work, rows):
    """Of EXEMPLAR_DATA; the meshes are read one category after the other."""
    for name in names or TRAINING:
        folder = pathlib.Path(os.environ["EXEMPLAR_DATA"]) / "labeled" / name
        paths = sorted(folder.glob("*.off"), key=lambda path: int(path.stem))
        train = [path for path in paths if int(path.stem) in TRAINING[name]]
        yield Category(name, train, [path for path in paths if path not in train][1::4][:TESTED], work, rows)


def generated_categories(names, work, rows, train=6, faces=5000):
    for name in names or GENERATED:
        folder = work / name / "shapes"
        if not folder.exists():
            subprocess.run([programs.program("exemplar"), "synth", name, "--count", str(train + TESTED), "--seed", "1", "--faces",
                            str(faces), "--out", folder, "--threads", "1", "--quiet"], check=True, stdout=subprocess.DEVNULL)
        paths = sorted(folder.glob("*.off"))
        yield Category(name, paths[:train], paths[train:], work, rows)


# Folds 1: a single classifier. Pooled is what 'exemplar label train' does, with a linear classifier, the next is that without it;
# plain is as in the thesis but for the number of rounds, which it chooses on held-out meshes.
OURS = {
    "JointBoost, pooled": {"folds": BOOSTING_FOLDS, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06, "linear": 1},
    "JointBoost": {"folds": BOOSTING_FOLDS, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06},
    "JointBoost, 1000 rounds": {"folds": BOOSTING_FOLDS, "rounds": 1000, "shrinkage": 0.5, "feature_fraction": 0.06},
    "JointBoost, equal labels": {"folds": BOOSTING_FOLDS, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06,
                                 "equal labels": True},
    "JointBoost, single": {"folds": 1, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06},
    "JointBoost, plain": {"folds": 1, "rounds": 300, "shrinkage": 1, "feature_fraction": 1},
}


class Result:
    """What a learner says of the test meshes: scores per mesh; and what it took."""

    def __init__(self, scores, train_seconds, score_seconds, parameters, scale):
        self.scores, self.train_seconds, self.score_seconds = scores, train_seconds, score_seconds
        self.parameters, self.scale = parameters, scale

    def save(self, path):
        path.parent.mkdir(exist_ok=True)
        known = json.dumps([self.train_seconds, self.score_seconds, self.parameters, self.scale])
        numpy.savez(path, *(scores.astype("f4") for scores in self.scores), known=known)

    @staticmethod
    def load(path):
        arrays = numpy.load(path)
        return Result([arrays[f"arr_{m}"] for m in range(len(arrays.files) - 1)], *json.loads(str(arrays["known"])))

    def probabilities(self, mesh):
        return softmax(self.scale * self.scores[mesh])

    def errors(self, category):
        """Of the surface and of labels, in percent; and the mean of -log of the truth's probability, by area."""
        both = [category.wrong(mesh, scores.argmax(axis=1)) for mesh, scores in zip(category.test, self.scores)]
        surface, label = 100 * numpy.mean(both, axis=0)
        return {"surface": surface, "label": label,
                "log loss": float(numpy.mean([self.log_loss(category, m) for m in range(len(category.test))]))}

    def log_loss(self, category, number):
        mesh = category.test[number]
        known = numpy.isin(mesh.label, category.labels)
        y = numpy.searchsorted(category.labels, mesh.label[known].astype(str))
        return log_loss(self.probabilities(number)[known], y, mesh.area[known])


def softmax(scores):
    scores = numpy.exp(scores - scores.max(axis=1, keepdims=True))
    return scores / scores.sum(axis=1, keepdims=True)


def log_loss(probability, y, weight):
    truth = (1 - NOISE) * probability[numpy.arange(len(y)), y] + NOISE / probability.shape[1]
    return -(weight * numpy.log(truth)).sum() / weight.sum()


def best_scale(scores, y, weight):
    """What held-out scores are multiplied with before the softmax."""
    return min(numpy.logspace(-1.5, 2, 36), key=lambda scale: log_loss(softmax(scale * scores), y, weight))


def held_out_scores(category, make, rows):
    """Of some of the training rows, each from the learner of the meshes of the other folds."""
    fold, labels = category.fold(HELD_OUT_FOLDS)[rows], len(category.labels)
    scores = numpy.zeros((len(rows), labels))
    for held_out in range(HELD_OUT_FOLDS):
        seen = rows[fold != held_out]
        model = Known(make(len(seen)), labels).fit(category.x[seen], category.y[seen], category.weight[seen])
        scores[fold == held_out] = model.scores(category.x[rows[fold == held_out]])
    return scores


def choose(category, factory, grid, rows):
    """The parameters with which the least of the surface is wrong, and the scale of the scores then."""
    best = None
    for parameters in ParameterGrid(grid):
        scores = held_out_scores(category, lambda count: factory(count, **parameters), rows)
        wrong = category.area[rows] @ (scores.argmax(axis=1) != category.y[rows]) / category.area[rows].sum()
        if best is None or wrong < best[0]:
            best = wrong, parameters, best_scale(scores, category.y[rows], category.weight[rows])
    return best[1:]


def by_peer(category, name, cv_rows):
    factory, grid = PEERS[name]
    parameters, scale = choose(category, factory, grid, category.cv_rows(cv_rows))
    start = time.process_time()
    model = Known(factory(len(category.y), **parameters), len(category.labels))
    model.fit(category.x, category.y, category.weight)
    trained = time.process_time()
    scores = [model.scores(mesh.features) for mesh in category.test]
    return Result(scores, trained - start, time.process_time() - trained, parameters, scale)


def held_out_errors(category, label):
    """Of the training rows, in percent: how much of the surface is wrong, and of each label in the mean."""
    right = category.area * (label == category.y)
    count = len(category.labels)
    of_label = numpy.bincount(category.y, right, count) / numpy.bincount(category.y, category.area, count)
    return {"held out, surface": round(100 * (1 - right.sum() / category.area.sum()), 1),
            "held out, labels": round(100 * (1 - of_label.mean()), 1)}


def by_ours(category, name):
    settings = {"classes": len(category.labels), "threads": 1, "linear": 0, **OURS[name]}
    weight = category.equal_weight if settings.pop("equal labels", False) else category.weight
    arrays = {"x": category.x.T, "label": category.y.astype("<i4"), "weight": weight.astype("<f4"),
              "fold": category.fold(BOOSTING_FOLDS).astype("u1"),
              "test": numpy.concatenate([mesh.features for mesh in category.test]).T}
    found, seconds = programs.run("compare_boost", [], arrays, settings, scratch=category.folder)
    ends = numpy.cumsum([len(mesh.area) for mesh in category.test])[:-1]
    known = held_out_errors(category, found["held_out"].argmax(axis=1)) if "held_out" in found else {}
    return Result(numpy.split(as_scores(found["probability"]), ends), float(seconds["train_seconds"]),
                  float(seconds["score_seconds"]), known, 1)


def compare(category, learners, cv_rows):
    """Results by learner; those that an earlier call found with as many rows are taken over."""
    results = {}
    for name in learners:
        kept = category.results(cv_rows) / f"{name}.npz"
        if kept.exists():
            results[name] = Result.load(kept)
            continue
        results[name] = by_ours(category, name) if name in OURS else by_peer(category, name, cv_rows)
        results[name].save(kept)
        errors = results[name].errors(category)
        print(f"{category.name:>10} {name:>20} {errors['surface']:5.1f} % of the surface, {errors['label']:5.1f} % of labels, "
              f"log loss {errors['log loss']:.3f}, {results[name].train_seconds:6.1f} s to train, "
              f"{results[name].score_seconds:5.1f} s to score {results[name].parameters or ''}", file=sys.stderr, flush=True)
    return results


def trained_model(category):
    """The model of 'exemplar label train' of these meshes; only its cut is used. Without coordinates, which no learner here has."""
    model = category.folder / "model.safetensors"
    if not model.exists():
        names = category.folder / "train.txt"
        names.write_text("".join(f"{path.resolve()}\n" for path in category.train_paths))
        subprocess.run([programs.program("exemplar"), "label", "train", names, "--out", model, "--stages", "1", "--rows",
                        str(CUT_ROWS), "--orientation", "no", "--threads", "1", "--cache", category.folder.parent / "cache", "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
    return model


def cut_errors(category, results):
    """Share of the surface that is wrong after the graph cut, in percent, per learner."""
    given = {f"{mesh.path.stem}/{name}": result.probabilities(number).astype("<f4")
             for number, mesh in enumerate(category.test) for name, result in results.items()}
    found = programs.run("compare_faces", ["cut", category.folder.parent / "cache", trained_model(category)], given,
                         scratch=category.folder, behind=category.test_paths)[0]
    return {name: 100 * float(numpy.mean([category.wrong(mesh, found[f"{mesh.path.stem}/{name}"])[0] for mesh in category.test]))
            for name in results}


def kept_cut_errors(category, results, cv_rows):
    """The same; those that an earlier call found are taken over."""
    kept = category.results(cv_rows) / "cut.json"
    known = json.loads(kept.read_text()) if kept.exists() else {}
    missing = {name: result for name, result in results.items() if name not in known}
    if missing:
        known.update(cut_errors(category, missing))
        kept.write_text(json.dumps(known))
    return known


def mean_over(by_category, name):
    return numpy.mean([of_learner[name] for of_learner in by_category.values()])


def print_table(title, learners, by_category):
    """A row per learner: its value in each category, and the mean."""
    rows = [(name, [f"{of_learner[name]:.1f}" for of_learner in by_category.values()] + [f"**{mean_over(by_category, name):.1f}**"])
            for name in learners]
    print("\n" + programs.table(title, [*by_category, "mean"], rows), flush=True)


def print_means(title, learners, tables):
    """A row per learner: the mean over categories of each table."""
    rows = [(name, [f"{mean_over(by_category, name):.2f}" for by_category in tables.values()]) for name in learners]
    print("\n" + programs.table(title, list(tables), rows), flush=True)


def draw(path, learners, surface, cut):
    """Bars of the mean errors, falling, before and after the cut."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    pyplot.rcParams.update({"font.size": 8, "svg.hashsalt": "exemplar"})
    order = sorted(learners, key=lambda name: -mean_over(surface, name))
    figure, axes = pyplot.subplots(figsize=(7, 0.3 * len(order) + 0.6), layout="constrained")
    colors = ["tab:blue" if name in OURS else "silver" for name in order]
    axes.barh(order, [mean_over(surface, name) for name in order], color=colors)
    for row, name in enumerate(order):
        points = [of_learner[name] for of_learner in surface.values()]
        axes.plot(points, [row] * len(points), "k.", markersize=2)
    if cut:
        axes.plot([mean_over(cut, name) for name in order], order, "|", color="tab:red", markersize=12, label="after the graph cut")
        axes.legend(frameon=False)
    axes.set_xlabel("surface labeled wrong, %: mean, and each category (dots)")
    figure.savefig(path, metadata={"Date": None} if str(path).endswith(".svg") else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("categories", nargs="*", help="only these")
    parser.add_argument("--work", type=pathlib.Path, required=True, metavar="FOLDER", help="keeps features and results")
    parser.add_argument("--learners", nargs="*", default=[*OURS, *PEERS], help="only these")
    parser.add_argument("--rows", type=int, default=1000, help="faces of each training mesh")
    parser.add_argument("--cv-rows", type=int, default=300, help="of these, for choosing parameters")
    parser.add_argument("--cut", action="store_true", help="also cut by the model of 'exemplar label train'")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also write all figures")
    parser.add_argument("--picture", metavar="FILE", help="also draw the errors")
    options = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)
    warnings.simplefilter("ignore", LinAlgWarning)  # of least squares, whose features depend on each other
    source = benchmark_categories if "EXEMPLAR_DATA" in os.environ else generated_categories
    tables = {what: {} for what in ("surface", "label", "log loss", "train", "score", "cut", "parameters")}
    for category in source(options.categories, options.work.resolve(), options.rows):
        results = compare(category, options.learners, options.cv_rows)
        errors = {name: result.errors(category) for name, result in results.items()}
        for what in ("surface", "label", "log loss"):
            tables[what][category.name] = {name: errors[name][what] for name in results}
        tables["train"][category.name] = {name: result.train_seconds for name, result in results.items()}
        tables["score"][category.name] = {name: result.score_seconds for name, result in results.items()}
        tables["parameters"][category.name] = {name: result.parameters for name, result in results.items()}
        if options.cut:
            tables["cut"][category.name] = kept_cut_errors(category, results, options.cv_rows)
        if options.json:
            options.json.write_text(json.dumps(tables, indent=1))
    print_table("surface wrong, %", options.learners, tables["surface"])
    print_table("labels wrong, %", options.learners, tables["label"])
    if options.cut:
        print_table("surface wrong after the cut, %", options.learners, tables["cut"])
    print_means("means", options.learners, {"log loss": tables["log loss"], "seconds to train": tables["train"],
                                            "seconds to score four meshes": tables["score"]})
    if options.picture:
        draw(options.picture, options.learners, tables["surface"], tables["cut"])


if __name__ == "__main__":
    main()
