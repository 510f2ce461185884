#include "host/animation/gltf_clips.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "host/animation/gltf_nodes.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::animation_io {
namespace {

using mesh_io::GltfReader;

enum class Path { translation, rotation, scale, weights };
enum class Interpolation { step, linear, cubic };

/// The keys of one channel. A key of a cubic spline has an in-tangent, a value and an out-tangent.
struct Track {
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t target = 0;  ///< node of the rig, or the first morph target
    std::size_t width = 0;     ///< numbers per value
    std::vector<float> times;
    std::vector<float> values;

    const float* value(std::size_t key) const {
        return values.data() + (interpolation == Interpolation::cubic ? 3 * key + 1 : key) * width;
    }
    const float* in_tangent(std::size_t key) const { return values.data() + 3 * key * width; }
    const float* out_tangent(std::size_t key) const { return values.data() + (3 * key + 2) * width; }
};

/// The animations of a file that are played together.
struct Take {
    std::string name;
    std::vector<Track> tracks;
    std::size_t merged = 1;  ///< number of animations it was merged from

    double first() const {
        double time = std::numeric_limits<double>::infinity();
        for (const Track& track : tracks) time = std::min<double>(time, track.times.front());
        return time;
    }
    double last() const {
        double time = -std::numeric_limits<double>::infinity();
        for (const Track& track : tracks) time = std::max<double>(time, track.times.back());
        return time;
    }
};

/// The position of a time between two keys.
struct KeyInterval {
    std::size_t key, next;
    double share;     ///< fraction of the time between them
    double duration;  ///< time between them, in seconds
};

/// Returns the place of `time`. Keys up to `slack` seconds later count as reached: times are floats, and a step must
/// not come a frame late.
KeyInterval key_interval_at(const std::vector<float>& times, double time, double slack) {
    const auto after =
        std::ranges::upper_bound(times, time + slack, {}, [](float t) { return static_cast<double>(t); });
    if (after == times.begin()) return {0, 0, 0, 0};
    const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end() || time <= times[key]) return {key, key, 0, 0};
    const double duration = static_cast<double>(*after) - times[key];
    return {key, key + 1, (time - times[key]) / duration, duration};
}

/// Evaluates the cubic Hermite spline of glTF 2.0, appendix C.
double spline(const Track& track, const KeyInterval& place, std::size_t i) {
    const double s = place.share, s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * track.value(place.key)[i] +
           place.duration * (s3 - 2 * s2 + s) * track.out_tangent(place.key)[i] +
           (3 * s2 - 2 * s3) * track.value(place.next)[i] +
           place.duration * (s3 - s2) * track.in_tangent(place.next)[i];
}

float component(const Track& track, const KeyInterval& place, std::size_t i) {
    const double a = track.value(place.key)[i], b = track.value(place.next)[i];
    if (track.interpolation == Interpolation::step || place.key == place.next) return static_cast<float>(a);
    if (track.interpolation == Interpolation::cubic) return static_cast<float>(spline(track, place, i));
    return static_cast<float>(a + place.share * (b - a));
}

Eigen::Quaternionf rotation(const Track& track, const KeyInterval& place) {
    const auto unit = [](const float* q) { return unit_quaternion(q[0], q[1], q[2], q[3]); };
    if (track.interpolation == Interpolation::linear && place.key != place.next)
        return unit(track.value(place.key))
            .slerp(static_cast<float>(place.share), unit(track.value(place.next)))
            .normalized();
    return unit_quaternion(component(track, place, 0), component(track, place, 1), component(track, place, 2),
                           component(track, place, 3));
}

void apply(const Track& track, double time, double slack, Pose& pose) {
    const KeyInterval place = key_interval_at(track.times, time, slack);
    const auto vec3 = [&] {
        return Vec3(component(track, place, 0), component(track, place, 1), component(track, place, 2));
    };
    switch (track.path) {
        case Path::translation:
            pose.nodes[track.target].translation = vec3();
            break;
        case Path::rotation:
            pose.nodes[track.target].rotation = rotation(track, place);
            break;
        case Path::scale:
            pose.nodes[track.target].scale = vec3();
            break;
        case Path::weights:
            for (std::size_t i = 0; i < track.width; ++i) pose.weights[track.target + i] = component(track, place, i);
    }
}

/// Reads the channels of a file and samples them.
class ClipReader {
  public:
    ClipReader(GltfReader& gltf, const GltfLinks& links, const ReadAnimationOptions& options, Animation& animation)
        : gltf_(gltf), links_(links), rate_(options.frames_per_second), animation_(animation) {}

    std::vector<Clip> read() {
        std::vector<Clip> clips;
        std::set<std::string> names;
        for (Take& take : merged(read_takes())) {
            std::string name = take.name.empty() ? fmt::format("clip_{}", clips.size()) : take.name;
            for (int i = 2; !names.insert(name).second; ++i) name = fmt::format("{} ({})", take.name, i);
            take.name = name;
            clips.push_back(sampled(take));
        }
        return clips;
    }

  private:
    std::vector<Take> read_takes() {
        std::vector<Take> takes;
        for (const tinygltf::Animation& source : gltf_.model().animations) {
            Take take{.name = source.name, .tracks = {}};
            for (const tinygltf::AnimationChannel& channel : source.channels) read_channel(source, channel, take);
            if (take.tracks.empty())
                animation_.warnings.push_back(fmt::format("the clip {} moves nothing of the surface; it was left out",
                                                          mesh_io::quote(source.name)));
            else
                takes.push_back(std::move(take));
        }
        return takes;
    }

    /// Adds a channel to the take; skips channels that the surface does not depend on.
    void read_channel(const tinygltf::Animation& source, const tinygltf::AnimationChannel& channel, Take& take) {
        if (channel.target_node < 0) return;
        gltf_.item(gltf_.model().nodes, channel.target_node, "node");
        const auto node = static_cast<std::size_t>(channel.target_node);
        const mesh_io::GltfSurface::Targets& targets = links_.targets[node];
        Track track;
        track.target = links_.rig_node[node];
        track.width = 3;
        if (channel.target_path == "weights") {
            track.path = Path::weights;
            track.target = targets.count ? targets.begin : k_invalid_index;
            track.width = targets.count;
        } else if (channel.target_path == "rotation") {
            track.path = Path::rotation;
            track.width = 4;
        } else if (channel.target_path == "scale") {
            track.path = Path::scale;
        } else if (channel.target_path != "translation") {
            return;
        }
        if (track.target == k_invalid_index) return;
        read_keys(gltf_.item(source.samplers, channel.sampler, "sampler"), source.name, track);
        take.tracks.push_back(std::move(track));
    }

    void read_keys(const tinygltf::AnimationSampler& sampler, const std::string& clip, Track& track) {
        if (sampler.interpolation == "STEP") track.interpolation = Interpolation::step;
        if (sampler.interpolation == "CUBICSPLINE") track.interpolation = Interpolation::cubic;
        track.times = gltf_.numbers(sampler.input, 1);
        const auto fail = [&](const std::string& message) {
            gltf_.fail(fmt::format("clip {}, accessor {}: {}", mesh_io::quote(clip), sampler.input, message));
        };
        if (track.times.empty()) fail("there are no keys");
        for (std::size_t i = 0; i < track.times.size(); ++i) {
            if (!std::isfinite(track.times[i])) fail(fmt::format("the time of key {} is not finite", i));
            if (i > 0 && track.times[i] < track.times[i - 1]) fail(fmt::format("key {} is before key {}", i, i - 1));
        }
        track.values = gltf_.numbers(sampler.output, track.path == Path::weights    ? 1
                                                     : track.path == Path::rotation ? 4
                                                                                    : 3);
        const std::size_t expected =
            track.times.size() * track.width * (track.interpolation == Interpolation::cubic ? 3 : 1);
        if (track.values.size() != expected)
            fail(fmt::format("{} keys need {} numbers, but accessor {} has {}", track.times.size(), expected,
                             sampler.output, track.values.size()));
    }

    /// Merges takes. FBX converters write an animation NODE|TAKE per node; those of one take are played together if
    /// they end at the same time and drive different nodes.
    std::vector<Take> merged(std::vector<Take> takes) {
        std::vector<Take> result;
        for (Take& take : takes) {
            const std::size_t bar = take.name.find('|');
            const std::string shared = bar == std::string::npos ? std::string() : take.name.substr(bar + 1);
            const auto fits = [&](const Take& other) {
                const std::size_t other_bar = other.name.find('|');
                return other_bar != std::string::npos && other.name.substr(other_bar + 1) == shared &&
                       std::abs(other.last() - take.last()) * rate_ < 0.5 && drive_different_numbers(other, take);
            };
            const auto other = shared.empty() ? result.end() : std::ranges::find_if(result, fits);
            if (other == result.end()) {
                result.push_back(std::move(take));
                continue;
            }
            std::ranges::move(take.tracks, std::back_inserter(other->tracks));
            ++other->merged;
        }
        for (Take& take : result) {
            if (take.merged == 1) continue;
            take.name = take.name.substr(take.name.find('|') + 1);
            animation_.warnings.push_back(fmt::format("{} animations of the take {} were merged into one clip",
                                                      take.merged, mesh_io::quote(take.name)));
        }
        return result;
    }

    static bool drive_different_numbers(const Take& a, const Take& b) {
        std::set<std::pair<Path, std::uint32_t>> driven;
        for (const Track& track : a.tracks) driven.emplace(track.path, track.target);
        return std::ranges::none_of(b.tracks, [&](const Track& track) {
            return driven.contains({track.path, track.target});
        });
    }

    Clip sampled(const Take& take) {
        constexpr double k_rounding = 0.01;  // in frames, since times are floats
        const double last = take.last();
        const bool one_key = take.first() == last;
        const double frames = one_key ? 1 : std::floor(std::max(last, 0.0) * rate_ + k_rounding) + 1;
        check_size(take, frames);
        Clip clip{.name = take.name, .frames_per_second = rate_, .poses = {}, .frames = {}};
        clip.poses.assign(static_cast<std::size_t>(frames), rest_pose(animation_.rig));
        for (std::size_t i = 0; i < clip.poses.size(); ++i)
            for (const Track& track : take.tracks)
                apply(track, one_key ? last : static_cast<double>(i) / rate_, k_rounding / rate_, clip.poses[i]);
        return clip;
    }

    /// Throws if the frames need far more memory than the file has: two keys a year apart take few bytes.
    void check_size(const Take& take, double frames) {
        constexpr double k_free_bytes = 16 << 20, k_bytes_per_byte = 1024;
        const Rig& rig = animation_.rig;
        pose_bytes_ += frames * static_cast<double>(sizeof(Pose) + rig.nodes.size() * sizeof(NodeTransform) +
                                                    rig.targets.size() * sizeof(float));
        if (pose_bytes_ > k_free_bytes + k_bytes_per_byte * static_cast<double>(gltf_.bytes()))
            gltf_.fail(
                fmt::format("clip {} lasts {:.6g} s, which is {:.6g} frames and far more than the file holds; "
                            "mend its last key, or read fewer frames per second",
                            mesh_io::quote(take.name), take.last(), frames));
    }

    GltfReader& gltf_;
    const GltfLinks& links_;
    double rate_;
    Animation& animation_;
    double pose_bytes_ = 0;
};

}  // namespace

std::vector<Clip> read_gltf_clips(GltfReader& gltf, const GltfLinks& links, const ReadAnimationOptions& options,
                                  Animation& animation) {
    return ClipReader(gltf, links, options, animation).read();
}

}  // namespace exemplar::animation_io
