#include "host/data/model_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "host/core/errors.h"

namespace exemplar {

void inconsistent(const TensorFile& file, const std::string& what) {
    throw ModelError(fmt::format("{}: damaged file: {}; train it again", file.path, what));
}

void require_finite(const TensorFile& file, const std::string& name, const std::vector<float>& values) {
    for (const float value : values)
        if (!std::isfinite(value)) inconsistent(file, name + " holds a value that is not finite");
}

void require_version(const TensorFile& file, const std::string& key, int known, const std::string& mend) {
    int version = 0;
    try {
        version = std::stoi(file.meta(key));
    } catch (const std::logic_error&) {
        inconsistent(file, key + " is no number");
    }
    if (version != known)
        throw ModelError(fmt::format("{}: {} is {}, this program knows {}; {}", file.path, key, version, known,
                                     version > known ? "use a newer Exemplar" : mend));
}

void add_classifier(TensorFile& file, const std::string& name, const CalibratedStumps& classifier) {
    const BoostedStumps& boosted = classifier.stumps;
    const std::size_t count = boosted.stumps.size();
    std::vector<std::uint32_t> feature;
    std::vector<float> values;
    std::vector<std::uint64_t> classes;
    for (const Stump& stump : boosted.stumps) {
        feature.push_back(stump.feature);
        values.insert(values.end(), {stump.threshold, stump.above, stump.below});
        classes.push_back(stump.classes);
    }
    file.add(name + ".feature", {count}, feature);
    file.add(name + ".threshold_above_below", {count, 3}, values);
    file.add(name + ".classes", {count}, classes);
    file.add(name + ".elsewhere", {count, boosted.class_count}, boosted.elsewhere);
    file.add(name + ".link", {1}, std::vector<std::uint32_t>{static_cast<std::uint32_t>(classifier.link)});
    file.add(name + ".scale", {1}, std::vector<float>{classifier.scale});
}

CalibratedStumps get_classifier(const TensorFile& file, const std::string& name, std::size_t class_count,
                                std::size_t feature_count) {
    const auto feature = file.get<std::uint32_t>(name + ".feature", {TensorFile::k_any});
    const std::size_t count = feature.size();
    const auto values = file.get<float>(name + ".threshold_above_below", {count, 3});
    const auto classes = file.get<std::uint64_t>(name + ".classes", {count});
    const auto link = file.get<std::uint32_t>(name + ".link", {1})[0];
    CalibratedStumps classifier;
    classifier.stumps.class_count = static_cast<std::uint32_t>(class_count);
    classifier.stumps.elsewhere = file.get<float>(name + ".elsewhere", {count, class_count});
    classifier.scale = file.get<float>(name + ".scale", {1})[0];
    require_finite(file, name + ".threshold_above_below", values);
    require_finite(file, name + ".elsewhere", classifier.stumps.elsewhere);
    if (link > 1) inconsistent(file, name + ".link is unknown");
    if (!(classifier.scale > 0) || !std::isfinite(classifier.scale))
        inconsistent(file, name + ".scale is not positive");
    classifier.link = static_cast<Link>(link);
    for (std::size_t m = 0; m < count; ++m) {
        if (feature[m] >= feature_count)
            inconsistent(file, fmt::format("{} uses feature {} of {}", name, feature[m], feature_count));
        if (class_count < 64 && classes[m] >> class_count != 0)
            inconsistent(file, fmt::format("{} has a stump of more than {} classes", name, class_count));
        classifier.stumps.stumps.push_back(
            {feature[m], values[3 * m], values[3 * m + 1], values[3 * m + 2], classes[m]});
    }
    return classifier;
}

}  // namespace exemplar
