#!/usr/bin/env python3
"""Writes the page of a labeling protocol from the report of `exemplar label evaluate`.

    docs/results/label_pages.py out/sb6/report.json > docs/results/labeling_sb6.md

The page holds all rates per category beside those of the thesis, the scatter of the splits, what is confused most, and the
features that boosting chose (thesis Fig. 3.5). Categories that were evaluated apart, as on several machines, make one page from
all their reports. With --peer in the evaluation, also the other program's rates per category, and on how
many meshes it is behind; --peer-name says whose labels these are.
"""
import argparse
import json
import statistics
import sys

PROTOCOLS = {
    'sb3': ('three training meshes', 'SB3'),
    'sb6': ('six training meshes', 'SB6'),
    'sb12': ('twelve training meshes', 'SB12'),
    'sb19': ('leave one out', 'SB19'),
    'pfcn': ('twelve training and eight test meshes of ShapePFCN', '12/8')}
RATES = [('recognition_rate', 'RR', 100), ('without_cut', 'no cut', 100), ('segment_weighted_accuracy', 'SW', 100),
         ('rand_error', 'RI', 100), ('cut_discrepancy', 'CD', 1), ('hamming_distance', 'HD', 100), ('missing_rate', 'Rm', 100),
         ('false_alarm_rate', 'Rf', 100), ('global_consistency_error', 'GCE', 100), ('local_consistency_error', 'LCE', 100)]
DEFAULTS = {'seed': 1, 'rounds': 300, 'patience': 50, 'stages': 3, 'bins': 128, 'rows': 4000, 'feature_fraction': 0.06,
            'shrinkage': 0.5, 'linear': True, 'boundary': True, 'samples': 1000, 'orientation': 'auto'}
VARIED = ('Bust', 'Bearing')  # categories whose labels differ so much from mesh to mesh that their rates are mostly chance


def shown(value, factor=100):
    """A rate in percent, or a number; '-' where there is none."""
    if value is None:
        return '-'
    return f'{value * factor:.1f}' if factor == 100 else f'{value:.3f}'


def mean(values):
    values = [value for value in values if value is not None]
    return statistics.mean(values) if values else None


def table(head, rows):
    lines = [head, ['---'] * len(head), *rows]
    return '\n'.join('| ' + ' | '.join(str(cell) for cell in line) + ' |' for line in lines)


def rate_row(name, categories):
    """The means over categories of their rates, and of the thesis' rates if all have them."""
    row = [name] + [shown(mean([c[key] for c in categories]), factor) for key, _, factor in RATES]
    for key in ('recognition_rate', 'rand_error'):
        of_thesis = [c.get('thesis', {}).get(key) for c in categories]
        row.append(shown(None if None in of_thesis else mean(of_thesis)))
    return row


def rates(report):
    categories = report['categories']
    rows = [rate_row(c['category'], [c]) for c in categories]
    rows.append([f'**{cell}**' for cell in rate_row('mean', categories)])
    others = [c for c in categories if c['category'] not in VARIED]
    if 0 < len(others) < len(categories):
        rows.append(rate_row('without ' + ' and '.join(VARIED), others))
    return table(['category'] + [column for _, column, _ in RATES] + ['thesis RR', 'thesis RI'], rows)


def scatter(report):
    """The means over the categories of each split."""
    categories = report['categories']
    count = min(len(c['splits']) for c in categories)
    rows = []
    for key, name, _ in RATES[:4]:
        of_split = [mean([mean([mesh[key] for mesh in c['splits'][k]['meshes']]) for c in categories]) for k in range(count)]
        rows.append([name] + [shown(value) for value in of_split])
    return table([''] + [f'split {k + 1}' for k in range(count)], rows)


def peer(report):
    columns = ['own_recognition_rate', 'recognition_rate', 'own_segment_weighted_accuracy', 'segment_weighted_accuracy']
    rows = []
    for name, one in [(c['category'], c['peer']) for c in report['categories'] if 'peer' in c] + [('mean', report['peer'])]:
        rows.append([name, one['meshes']] + [shown(one[key]) for key in columns] + [one['ahead'], one['behind']])
    return table(['category', 'meshes', 'RR', 'its RR', 'SW', 'its SW', 'ahead', 'behind'], rows)


def confused(report):
    rows = []
    for category in report['categories']:
        for pair in category['confused'][:2]:
            if pair['area_share'] >= 0.005:
                rows.append([category['category'], pair['truth'], pair['predicted'], shown(pair['area_share']), shown(pair['label_share'])])
    return table(['category', 'label', 'taken for', '% of the surface', '% of the label'], rows)


def families(report):
    stages = report['features']
    total = {}
    for stage in stages:
        for family, share in stage['share_per_family'].items():
            total[family] = total.get(family, 0) + share * stage['stumps']
    rows = [[family] + [shown(stage['share_per_family'].get(family, 0)) for stage in stages]
            for family in sorted(total, key=total.get, reverse=True)]
    return table(['family'] + [stage['stage'] for stage in stages], rows)


def sum_features(of_categories):
    """The shares of the families in all models: per stage, the mean over the stumps."""
    total = []
    for number in range(max(len(stages) for stages in of_categories)):
        stages = [stages[number] for stages in of_categories if number < len(stages)]
        stumps = sum(stage['stumps'] for stage in stages)
        names = sorted({family for stage in stages for family in stage['share_per_family']})
        shares = {family: sum(stage['share_per_family'].get(family, 0) * stage['stumps'] for stage in stages) / max(stumps, 1)
                  for family in names}
        total.append({'stage': stages[0]['stage'], 'stumps': stumps, 'share_per_family': shares})
    return total


def sum_peers(peers):
    """Counts are summed over the categories, rates averaged."""
    counts = ('meshes', 'ahead', 'behind')
    return {key: sum(peer[key] for peer in peers) if key in counts else mean([peer[key] for peer in peers]) for key in peers[0]}


def merge(reports):
    """One report of the categories of all. Raises ValueError if they do not belong together."""
    first, categories = reports[0], [category for report in reports for category in report['categories']]
    if any(report[key] != first[key] for report in reports for key in ('protocol', 'options')):
        raise ValueError('the reports are of other protocols or other options')
    names = [category['category'] for category in categories]
    if len(set(names)) < len(names):
        raise ValueError('two reports hold the same category')
    merged = {**first, 'categories': categories, 'features': sum_features([c['features'] for c in categories])}
    if peers := [category['peer'] for category in categories if 'peer' in category]:
        merged['peer'] = sum_peers(peers)
    return merged


def changed_options(options):
    """The options of the training that differ from the defaults, as in the command."""
    words = ''
    for name, usual in DEFAULTS.items():
        if options[name] is False:
            words += f' --no-{name}'
        elif options[name] != usual:
            words += f' --{name.replace("_", "-")} {options[name]}'
    return words


def page(report, peer_name):
    words, short = PROTOCOLS[report['protocol']]
    categories, options = report['categories'], report['options']
    splits = max(len(c['splits']) for c in categories)
    trainings = sum(len(c['splits']) for c in categories)
    command = f'exemplar label evaluate --protocol {report["protocol"]} psb/labeled'
    if splits > 1 and report['protocol'] not in ('sb19', 'pfcn'):
        command += f' --splits {splits}'
    command += changed_options(options) + f' --out out/{report["protocol"]}' + (' --peer peer' if 'peer' in report else '')
    text = [f'# Labeling: {words} ({short})', '',
            f'Written by `docs/results/label_pages.py` from the report of this command ({trainings} trainings, '
            f'{sum(c["meshes"] for c in categories)} labelings of unseen meshes; version {options["training"]} of the training, '
            f'{options["features"]} of the features):', '',
            f'    {command}', '',
            'In percent, but CD. RR: recognition rate. No cut: the recognition rate of the classifiers alone. SW: segment-weighted',
            'accuracy. Against all human segmentations: RI, Rand index error; CD, cut discrepancy; HD, Hamming distance, the mean of Rm',
            '(missing) and Rf (false alarms); GCE and LCE, global and local consistency error.', '',
            rates(report), '']
    if report['protocol'] == 'pfcn':
        text += ['The thesis draws twelve training meshes at random; the test meshes here are those of ShapePFCN.', '']
    if 'peer' in report:
        text += [f'## Beside {peer_name}', '', 'Ahead and behind count meshes by recognition rate.', '', peer(report), '']
    if splits > 1 and report['protocol'] != 'sb19':
        text += ['## Scatter of the splits', '', 'Means over the categories:', '', scatter(report), '']
    text += ['## What is confused most', '', confused(report), '', '## Chosen features', '',
             'Percent of the stumps of each classifier that use a feature of the family (thesis Fig. 3.5).', '', families(report), '']
    return '\n'.join(text)


def read(path):
    """Reads a report; ends the program with one line if the file is none."""
    try:
        with open(path, encoding='utf-8') as file:
            report = json.load(file)
        if report['protocol'] not in PROTOCOLS:
            sys.exit(f'{path}: is the report of no protocol; call `exemplar label evaluate --protocol`')
        return report
    except (OSError, KeyError, TypeError, json.JSONDecodeError) as error:
        sys.exit(f'{path}: is no report of `exemplar label evaluate` ({error!r})')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('report', nargs='+', help='report.json in the --out folder of the evaluation, or those of its categories')
    parser.add_argument('--peer-name', default='another program', help="whose labels were the evaluation's --peer")
    options = parser.parse_args()
    reports = [read(path) for path in options.report]
    try:
        print(page(merge(reports), options.peer_name), end='')
    except ValueError as error:
        sys.exit(f'{", ".join(options.report)}: cannot be made a page ({error})')
    except (KeyError, TypeError) as error:
        sys.exit(f'{", ".join(options.report)}: is no report of `exemplar label evaluate` ({error!r})')


if __name__ == '__main__':
    main()
