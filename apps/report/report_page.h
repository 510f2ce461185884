#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// One number about a labeling and, where it is known, the number to compare it with (e.g. a publication's).
struct ReportMeasure {
    std::string name;  ///< e.g. "Rand index error"; measures of the same name share a column
    double value = std::numeric_limits<double>::quiet_NaN();      ///< NaN if unknown
    double reference = std::numeric_limits<double>::quiet_NaN();  ///< NaN if there is none
    bool lower_is_better = false;
    bool share = true;  ///< value and reference are shares, shown in percent; false: shown as they are
};

/// The numbers of one tested mesh, whether or not the mesh is among those that can be turned.
struct ReportScore {
    std::string name;
    std::vector<ReportMeasure> measures;
};

/// How well held-out items were labeled after so many rounds (see HeldOutPoint).
struct ReportCurvePoint {
    std::size_t rounds = 0;
    double loss = 0, error = 0;  ///< log loss; share of wrong labels in [0, 1]. NaN leaves a gap
};

/// The validation curve of one classifier of a cascade.
struct ReportCurve {
    std::string name;                      ///< e.g. "unary 0"
    std::vector<ReportCurvePoint> points;  ///< rounds ascending
    std::size_t chosen_rounds = 0;         ///< how many rounds were kept; marked in the plot. 0 = no mark
    bool kept = true;                      ///< false for a classifier that was tried and dropped
};

/// How many stumps of one classifier use each family of features.
struct ReportStageFeatures {
    std::string stage;  ///< e.g. "unary 0"
    std::vector<std::pair<std::string, std::size_t>> families;
};

/// One labeled mesh of a report. All per-face values are per triangle of `mesh`, not per polygon of its file.
struct ReportMesh {
    std::string name;                     ///< any text, e.g. the file's stem
    const TriangleMesh* mesh = nullptr;   ///< must outlive the call that writes the page
    std::vector<std::int32_t> predicted;  ///< index into ReportData::label_names
    std::vector<std::int32_t> truth;      ///< the same, or -1 where unlabeled; empty if there is no ground truth
    std::vector<float> confidence;        ///< probability of the predicted label, in [0, 1]
    std::vector<float> entropy;   ///< of the labels' probabilities, divided by log C, in [0, 1]; empty if unknown
    std::vector<float> border;    ///< probability that a part ends at the face, in [0, 1]; empty if unknown
    double recognition_rate = 0;  ///< share of the area labeled right, in [0, 1]; NaN if unknown
};

/// A table of texts, shown below all others; columns of numbers are aligned right.
struct ReportTable {
    std::string title, note;
    std::vector<std::string> columns;            ///< headings
    std::vector<std::vector<std::string>> rows;  ///< a text per column each
};

/// One group of a report, e.g. a category: its meshes, and what is known about the model that labeled them.
/// Empty tables are left out of the page.
struct ReportData {
    std::string title, subtitle;
    std::vector<std::string> label_names;  ///< C names, C <= 255
    std::vector<Color> label_colors;       ///< C sRGB colors
    std::vector<ReportMesh> meshes;        ///< any order; the page shows the worst first and side by side
    double recognition_rate = std::numeric_limits<double>::quiet_NaN();  ///< of the group, in [0, 1]; NaN if unknown
    std::vector<double> confusion;                                       ///< C x C, row = truth, share of area
    std::vector<std::pair<std::string, std::size_t>> feature_families;   ///< family, number of stumps in all stages
    std::vector<std::string> first_features;                             ///< in the order they were chosen
    std::vector<std::pair<std::string, double>> timings;                 ///< what, seconds
    std::vector<std::pair<std::string, std::string>> summary;            ///< key, value; shown in large type
    /// Means over the group's tested meshes. The page begins with a table of all groups: one row per group, one column
    /// per name, those with references compared, and the mean over the groups.
    std::vector<ReportMeasure> measures;
    std::string reference_name = "reference";         ///< heads the columns of references, e.g. "thesis"
    std::vector<ReportScore> scores;                  ///< of every tested mesh
    std::vector<ReportStageFeatures> stage_features;  ///< in the order of the cascade
    std::vector<ReportCurve> curves;                  ///< in the order of the cascade
    std::vector<ReportTable> tables;                  ///< of anything else
};

/// A drawing below the groups.
struct ReportDrawing {
    std::string title, text;            ///< plain text
    std::string svg;                    ///< a whole file; may be animated; no scripts, no external references
    std::vector<std::string> captions;  ///< of equally wide parts, from the left
};

/// Writes one self-contained HTML file on the groups: a table that compares them, turnable views of labeled meshes
/// (predicted labels, ground truth, errors, confidence, entropy, borders; the first three also side by side),
/// confusion, scores, curves, features and timings. It opens from file:// in any browser with WebGL; without WebGL the
/// tables remain. Positions are rounded to 1 / 65535 of the mesh's bounding box; confidences, entropies and borders to
/// 1 / 255. F triangles and V vertices cost (6 V + 9 F) * 4 / 3 bytes, or (6 V + 15 F) * 4 / 3 beyond 65536 vertices;
/// entropies and borders F * 4 / 3 more each. Written atomically; equal arguments give equal bytes.
///
/// Throws UsageError naming the mesh or table if a label index or a share is out of range, a size does not match, a
/// coordinate is not finite, the rounds of a curve do not ascend, or there is no group; DataError if it cannot write.
void write_report_page(const std::filesystem::path& path, const std::string& title, std::span<const ReportData> groups,
                       std::span<const ReportDrawing> drawings = {});

}  // namespace exemplar
