#!/usr/bin/python3
"""Exemplar's features with scikit-learn: a random forest beside Exemplar's own labels, on generated quadrupeds.

Run it as it is, or cell by cell (`# %%`) in an editor that knows notebooks. Debian: python3-sklearn."""

# %% What it needs
import os
import time

import numpy as np
from sklearn.ensemble import RandomForestClassifier

import exemplar

FACES = int(os.environ.get("EXAMPLE_FACES", 3000))  # of each shape
SHAPES = int(os.environ.get("EXAMPLE_SHAPES", 6))  # to learn from; as many others are labeled
ROUNDS = int(os.environ.get("EXAMPLE_ROUNDS", 100))  # of Exemplar's boosting; its own default, 300, is slower

# %% Shapes with known labels: others to learn from than to be measured on
seen = [exemplar.make_shape("fourleg", seed, FACES) for seed in range(1, SHAPES + 1)]
unseen = [exemplar.make_shape("fourleg", seed, FACES) for seed in range(101, SHAPES + 101)]
names = np.array(seen[0].label_names)
print(f"{SHAPES} quadrupeds of {FACES} faces to learn from, as many to be labeled; labels: {', '.join(names)}")


# %% How good labels are: the share of the surface that is labeled right
def share_right(shape, labels):
    return 100 * np.average(np.asarray(labels) == shape.labels, weights=shape.face_areas())


# %% Features: a row for each face. A cache remembers them for Exemplar's own training, which needs the same.
cache = os.environ.get("EXAMPLE_CACHE", "")
begin = time.time()
features = {shape.name: exemplar.features(shape, cache=cache) for shape in seen + unseen}
table = np.concatenate([features[shape.name].values for shape in seen])
print(f"{table.shape[0]} faces x {table.shape[1]} features in {time.time() - begin:.0f} s")

# %% A random forest: each face by itself. Large faces count more, as they do when shapes are scored.
begin = time.time()
forest = RandomForestClassifier(100, min_samples_leaf=3, n_jobs=-1, random_state=1)
forest.fit(table, np.concatenate([shape.labels for shape in seen]),
           sample_weight=np.concatenate([shape.face_areas() for shape in seen]))
forest_rates = [share_right(shape, forest.predict(features[shape.name].values)) for shape in unseen]
print(f"random forest: {time.time() - begin:.0f} s")

# %% Which families of features it looks at
importance = {}
for name, value in zip(features[seen[0].name].names, forest.feature_importances_):
    family = name.split(".")[0]
    importance[family] = importance.get(family, 0) + value
for family, value in sorted(importance.items(), key=lambda item: -item[1]):
    print(f"  {family:14} {100 * value:5.1f} %")

# %% Exemplar: boosted stumps in a cascade, and a cut that places the borders
begin = time.time()
model = exemplar.train_labeling(seen, rounds=ROUNDS, cache=cache)
labelings = [model.label(shape, cache=cache) for shape in unseen]
exemplar_rates = []
for shape, labeling in zip(unseen, labelings):
    number = [shape.label_names.index(name) for name in labeling.label_names]  # the model sorts its labels
    exemplar_rates.append(share_right(shape, np.array(number)[labeling.labels]))
print(f"Exemplar: {time.time() - begin:.0f} s")

# %% Both beside each other
print(f"{'unseen shape':14} {'forest':>8} {'Exemplar':>10}")
for shape, ours, theirs in zip(unseen, exemplar_rates, forest_rates):
    print(f"{shape.name:14} {theirs:6.1f} % {ours:8.1f} %")
print(f"mean of the random forest: {np.mean(forest_rates):.1f} %")
print(f"mean of Exemplar: {np.mean(exemplar_rates):.1f} %")
