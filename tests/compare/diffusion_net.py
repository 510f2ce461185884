#!/usr/bin/env python3
"""Labels the test meshes of 'exemplar label evaluate' by DiffusionNet, trained on the same meshes, for its --peer.

    exemplar label evaluate --protocol sb6 psb/labeled --out out/sb6
    tests/compare/diffusion_net.py out/sb6/report.json --out peers/diffusion_net
    exemplar label evaluate --protocol sb6 psb/labeled --out out/sb6 --peer peers/diffusion_net

The network is that of Sharp, Attaiki, Crane and Ovsjanikov, DiffusionNet: Discretization Agnostic Learning on Surfaces, ACM
Transactions on Graphics 2022, written anew and trained from scratch, per category, on the training meshes of the split. As in
their segmentation of people:
- four blocks of width 128: diffusion by 128 eigenpairs of the cotangent Laplacian with learned times, gradient features, a
  perceptron per vertex with dropout; outputs are averaged from vertices to faces;
- input is the heat kernel signature at 16 times from 0.01 to 1, or the position, turned at random in each step (--input xyz);
- Adam, 200 epochs, a step per mesh, rate 0.001, halved after every quarter of the epochs; cross entropy without label
  smoothing, which they use for classification only.
Other than theirs: meshes have area 1 (theirs: radius 1), and a face counts in the loss by its area. Faces without a label do not
count.

A step takes 0.6 s on 10,000 vertices: two and a half hours for twelve categories of six training meshes. With --points N a step
looks at N vertices, drawn by area, and projects the features at these on the eigenvectors by least squares. The network and the
eigenvectors stay those of the full meshes, and test meshes are labeled as without --points. With 2000 it takes half an hour.

OUT/CATEGORY/NAME_labels.txt are the labels, OUT/CATEGORY/training.json says how they were learned. What is there already is
not learned again. Runs in one thread; equal options give equal files. Needs PyTorch and SciPy (Debian: python3-torch,
python3-scipy)."""

import os

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")  # before numpy

import pathlib
import time
import typing

import numpy
import torch
from scipy.spatial.transform import Rotation

import peer
from peer import Labels, positive
from surfaces import DataError, Surface, labels_path, read_labels, write_labels

torch.set_num_threads(1)

WIDTH, BLOCKS, DROPOUT = 128, 4, 0.5
RATE, QUARTERS = 1e-3, 4
LEAST_TIME = 1e-8     # of diffusion
RIDGE = 1e-3          # of the projection from some vertices, as a share of their number


class Points(typing.NamedTuple):
    """What the network knows of some vertices of a surface: n vertices, k eigenpairs."""

    basis: torch.Tensor        # n x k: the eigenvectors
    projection: torch.Tensor   # k x n: from values at the vertices to coefficients of the eigenvectors
    eigenvalues: torch.Tensor  # k
    gradient_x: torch.Tensor   # n x k: components of the gradients of the eigenvectors in the tangent planes
    gradient_y: torch.Tensor


class Block(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.time = torch.nn.Parameter(torch.zeros(WIDTH))
        # Together a complex matrix, which scales and turns gradients.
        self.real = torch.nn.Linear(WIDTH, WIDTH, bias=False)
        self.imaginary = torch.nn.Linear(WIDTH, WIDTH, bias=False)
        self.perceptron = torch.nn.Sequential(
            torch.nn.Linear(3 * WIDTH, WIDTH), torch.nn.ReLU(), torch.nn.Dropout(DROPOUT),
            torch.nn.Linear(WIDTH, WIDTH), torch.nn.ReLU(), torch.nn.Dropout(DROPOUT), torch.nn.Linear(WIDTH, WIDTH))

    def forward(self, x, points):
        with torch.no_grad():
            self.time.clamp_(min=LEAST_TIME)
        heat = torch.exp(-points.eigenvalues[:, None] * self.time) * (points.projection @ x)
        return x + self.perceptron(torch.cat([x, points.basis @ heat, self.gradient_features(heat, points)], dim=1))

    def gradient_features(self, heat, points):
        """Returns the inner products of the gradients with the scaled and turned gradients; they are the same in every frame.

        The matrix is applied to the coefficients, which are fewer than the vertices: it commutes with the gradient."""
        columns = torch.cat([heat, self.real(heat), self.imaginary(heat)], dim=1)
        x, x_real, x_imaginary = (points.gradient_x @ columns).chunk(3, dim=1)
        y, y_real, y_imaginary = (points.gradient_y @ columns).chunk(3, dim=1)
        return torch.tanh(x * (x_real - y_imaginary) + y * (y_real + x_imaginary))


class Network(torch.nn.Module):
    """Takes features of vertices to scores of labels at the same vertices."""

    def __init__(self, features, labels):
        super().__init__()
        self.first = torch.nn.Linear(features, WIDTH)
        self.blocks = torch.nn.ModuleList(Block() for _ in range(BLOCKS))
        self.last = torch.nn.Linear(WIDTH, labels)

    def forward(self, x, points):
        x = self.first(x)
        for block in self.blocks:
            x = block(x, points)
        return self.last(x)


class Shape:
    """A surface as the network takes it. 'target' is the number of the label of each face, -1 for none."""

    def __init__(self, surface, kind, target=None):
        tensor = lambda array: torch.from_numpy(numpy.ascontiguousarray(array, "f4"))
        self.points = Points(tensor(surface.eigenvectors), tensor((surface.eigenvectors * surface.mass[:, None]).T),
                             tensor(surface.eigenvalues), tensor(surface.gradient_x), tensor(surface.gradient_y))
        self.features = tensor(surface.hks if kind == "hks" else surface.positions)
        self.is_turned = kind == "xyz"
        self.corners = torch.from_numpy(surface.corners.astype("i8"))
        self.share = surface.areas.astype(float) / surface.areas.sum(dtype=float)
        self.target = None if target is None else torch.from_numpy(target)

    def turned(self, features, random):
        if not self.is_turned:
            return features
        return features @ torch.from_numpy(Rotation.random(random_state=random).as_matrix().astype("f4"))

    def face_scores(self, network, features):
        return network(features, self.points)[self.corners].mean(dim=1)

    def loss(self, network, random, most_points):
        """Returns the mean cross entropy over the labeled surface, or over some points of it."""
        if most_points and most_points < len(self.features):
            return self.sampled_loss(network, random, most_points)
        scores = self.face_scores(network, self.turned(self.features, random))
        is_known = self.target >= 0
        return mean_cross_entropy(scores[is_known], self.target[is_known], torch.from_numpy(self.share).float()[is_known])

    def sampled_loss(self, network, random, count):
        """Draws faces by area, and a corner of each: vertices by their mass, with a label."""
        faces = random.choice(len(self.share), count, p=self.share)
        vertices = self.corners[faces, random.randint(3, size=count)]
        scores = network(self.turned(self.features[vertices], random), points_at(self.points, vertices))
        target = self.target[faces]
        is_known = target >= 0
        return mean_cross_entropy(scores[is_known], target[is_known], torch.ones(int(is_known.sum())))


def mean_cross_entropy(scores, target, weight):
    each = torch.nn.functional.cross_entropy(scores, target, reduction="none")
    return (weight * each).sum() / weight.sum().clamp(min=1e-12)


def points_at(points, vertices):
    """Returns the points of some vertices, drawn by mass. A sum of the eigenvectors keeps its coefficients, but for the ridge."""
    basis = points.basis[vertices]
    squares = basis.T @ basis + RIDGE * len(vertices) * torch.eye(basis.shape[1])
    return Points(basis, torch.linalg.solve(squares, basis.T), points.eigenvalues, points.gradient_x[vertices],
                  points.gradient_y[vertices])


def train(shapes, labels, options, progress=lambda epoch, loss: None):
    """Returns a network that was trained from scratch, and the mean loss of each epoch."""
    torch.manual_seed(options.seed)
    random = numpy.random.RandomState(options.seed)
    network = Network(shapes[0].features.shape[1], labels).train()
    adam = torch.optim.Adam(network.parameters(), lr=RATE)
    rate = torch.optim.lr_scheduler.StepLR(adam, max(1, options.epochs // QUARTERS), gamma=0.5)
    losses = []
    for epoch in range(options.epochs):
        of_shape = []
        for number in random.permutation(len(shapes)):
            loss = shapes[number].loss(network, random, options.points)
            adam.zero_grad(set_to_none=True)
            loss.backward()
            adam.step()
            of_shape.append(loss.item())
        rate.step()
        losses.append(float(numpy.mean(of_shape)))
        progress(epoch + 1, losses[-1])
    return network.eval(), losses


def predicted(network, shape):
    """Returns the number of the best label of each face."""
    with torch.no_grad():
        return shape.face_scores(network, shape.features).argmax(dim=1).numpy()


def labels_of(split, options):
    return Labels(split, options.out, {name: getattr(options, name) for name in ("input", "points", "epochs", "seed")})


def training_shapes(split, options):
    """Returns the shapes to learn from, and the names of their labels."""
    surfaces = [Surface.of(path, options.work) for path in split.train]
    labels = [read_labels(labels_path(path), len(surface.areas)) for path, surface in zip(split.train, surfaces)]
    names = sorted(set(numpy.concatenate(labels)) - {""})
    if not names:
        raise DataError(labels_path(split.train[0]), "nor another training mesh has labels")
    number = {"": -1} | {name: n for n, name in enumerate(names)}
    targets = [numpy.array([number[name] for name in of_mesh], "i8") for of_mesh in labels]
    return [Shape(surface, options.input, target) for surface, target in zip(surfaces, targets)], names


def label_category(split, options, progress):
    labels = labels_of(split, options)
    start = time.monotonic()
    progress.say(f"{split.category}: {len(split.train)} training meshes, {len(split.test)} test meshes")
    shapes, names = training_shapes(split, options)

    def say(epoch, loss):
        if progress.is_due():
            progress.say(f"{split.category}: epoch {epoch} of {options.epochs}, loss {loss:.3f}", epoch / options.epochs)

    network, losses = train(shapes, len(names), options, say)
    for path in split.test:
        shape = Shape(Surface.of(path, options.work), options.input)
        write_labels(labels.path(path), numpy.array(names, dtype=object)[predicted(network, shape)])
    seconds = time.monotonic() - start
    labels.complete({"seconds": round(seconds, 1), "loss": [round(loss, 4) for loss in losses]})
    progress.say(f"{split.category}: labeled, {seconds:.0f} s, loss {losses[-1]:.3f}", 1)


def parse(arguments):
    parser = peer.parser(__doc__)
    parser.add_argument("--input", choices=("hks", "xyz"), default="hks", help="features of the vertices")
    parser.add_argument("--points", type=positive, metavar="N", help="vertices of a mesh that a step looks at; all unless given")
    parser.add_argument("--epochs", type=positive, default=200)
    parser.add_argument("--work", type=pathlib.Path, metavar="FOLDER",
                        help="keeps eigenvectors and gradients, about 7 MB a mesh; OUT/../operators unless given")
    options = peer.parse(parser, arguments)
    options.work = options.work or options.out.parent / "operators"
    return options


def main(arguments=None):
    options = parse(arguments)
    peer.label_all(options, lambda split: labels_of(split, options).are_complete(),
                   lambda split, progress: label_category(split, options, progress))


if __name__ == "__main__":
    main()
