// The keys of an animation, for each node and for the weights of morph targets.
#include "apps/import/tracks.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

namespace exemplar::import {
namespace {

constexpr double k_samples_per_second = 60;
constexpr double k_most_samples = 36000;  // ten minutes; chains that move for longer are sampled at their keys alone

double seconds_per_tick(const aiAnimation& animation) {
    constexpr double k_usual_rate = 25;  // where the file names none, as in the library's own viewer
    return 1 / (animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : k_usual_rate);
}

std::vector<float> numbers_of_key(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}
std::vector<float> numbers_of_key(const aiQuaternion& q) {
    return {q.x, q.y, q.z, q.w};
}

/// Adds a key unless one of its numbers is not finite.
void add_key(Track& track, double time, const std::vector<float>& numbers) {
    const auto is_finite = [](float x) { return std::isfinite(x); };
    if (!is_finite(static_cast<float>(time)) || !std::ranges::all_of(numbers, is_finite)) return;
    track.times.push_back(static_cast<float>(time));
    track.values.insert(track.values.end(), numbers.begin(), numbers.end());
}

/// Returns the keys in increasing order, which some files lack.
template <typename Key>
std::vector<Key> sorted_keys(const Key* keys, unsigned count) {
    std::vector<Key> sorted(keys, keys + count);
    std::erase_if(sorted, [](const Key& key) { return !std::isfinite(key.mTime); });
    std::ranges::stable_sort(sorted, {}, &Key::mTime);
    return sorted;
}

template <typename Key>
Track track_of(const Key* keys, unsigned count, double tick) {
    Track track;
    for (const Key& key : sorted_keys(keys, count)) add_key(track, key.mTime * tick, numbers_of_key(key.mValue));
    return track;
}

aiVector3D between(const aiVector3D& a, const aiVector3D& b, float share) {
    return a + (b - a) * share;
}
aiQuaternion between(const aiQuaternion& a, const aiQuaternion& b, float share) {
    aiQuaternion out;
    aiQuaternion::Interpolate(out, a, b, share);
    return out.Normalize();
}

/// The motion of one part of a chain.
class PartMotion {
  public:
    PartMotion(const aiNode& part, const aiNodeAnim* channel) : rest_(part.mTransformation) {
        if (!channel) return;
        positions_ = sorted_keys(channel->mPositionKeys, channel->mNumPositionKeys);
        rotations_ = sorted_keys(channel->mRotationKeys, channel->mNumRotationKeys);
        scales_ = sorted_keys(channel->mScalingKeys, channel->mNumScalingKeys);
    }

    void add_times(std::vector<double>& ticks) const {
        const auto add = [&](const auto& keys) {
            if (keys.size() < 2) return;  // the library adds single keys at time 0 for what does not move
            for (const auto& key : keys) ticks.push_back(key.mTime);
        };
        add(positions_);
        add(rotations_);
        add(scales_);
    }

    Matrix at(double tick) const {
        if (positions_.empty() && rotations_.empty() && scales_.empty()) return Matrix(rest_);
        aiVector3D scale, position;
        aiQuaternion rotation;
        rest_.Decompose(scale, rotation, position);
        Matrix moved(aiMatrix4x4(value_at(scales_, tick, scale), value_at(rotations_, tick, rotation),
                                 value_at(positions_, tick, position)));
        return moved;
    }

  private:
    template <typename Key, typename Value>
    static Value value_at(const std::vector<Key>& keys, double tick, const Value& at_rest) {
        if (keys.empty()) return at_rest;
        const auto after = std::ranges::upper_bound(keys, tick, {}, &Key::mTime);
        if (after == keys.begin()) return keys.front().mValue;
        if (after == keys.end()) return keys.back().mValue;
        const Key& before = *(after - 1);
        const double share = (tick - before.mTime) / (after->mTime - before.mTime);
        return between(before.mValue, after->mValue, static_cast<float>(share));
    }

    aiMatrix4x4 rest_;
    std::vector<aiVectorKey> positions_, scales_;
    std::vector<aiQuatKey> rotations_;
};

/// Returns the times of keys, and those of frames between the first and the last one.
std::vector<double> sample_ticks(const std::vector<PartMotion>& parts, double tick) {
    std::vector<double> ticks;
    for (const PartMotion& part : parts) part.add_times(ticks);
    if (ticks.empty()) return {0};
    const auto [first, last] = std::ranges::minmax(ticks);
    const double from = std::ceil(first * tick * k_samples_per_second), to = last * tick * k_samples_per_second;
    if (to - from < k_most_samples)
        for (double frame = from; frame < to; ++frame) ticks.push_back(frame / k_samples_per_second / tick);
    std::ranges::sort(ticks);
    ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
    return ticks;
}

NodeTracks sampled_chain(const std::vector<PartMotion>& parts, double tick) {
    NodeTracks tracks;
    for (const double time : sample_ticks(parts, tick)) {
        Matrix local;
        for (const PartMotion& part : parts) local *= part.at(time);
        aiVector3t<double> scale, position;
        aiQuaterniont<double> rotation;
        local.Decompose(scale, rotation, position);
        const auto narrow = [](const aiVector3t<double>& v) {
            return aiVector3D(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
        };
        const aiQuaternion turned(static_cast<float>(rotation.w), static_cast<float>(rotation.x),
                                  static_cast<float>(rotation.y), static_cast<float>(rotation.z));
        add_key(tracks.translation, time * tick, numbers_of_key(narrow(position)));
        add_key(tracks.rotation, time * tick, numbers_of_key(turned));
        add_key(tracks.scale, time * tick, numbers_of_key(narrow(scale)));
    }
    return tracks;
}

using Channels = std::map<std::size_t, const aiNodeAnim*>;  // by the part of the chain that they move

NodeTracks tracks_of(const SceneNode& node, const Channels& channels, double tick) {
    // The library writes a channel of the last part for a chain of rotations; it holds the product of all parts.
    if (const auto whole = channels.find(node.parts.size() - 1); whole != channels.end()) {
        const aiNodeAnim& channel = *whole->second;
        return {.translation = track_of(channel.mPositionKeys, channel.mNumPositionKeys, tick),
                .rotation = track_of(channel.mRotationKeys, channel.mNumRotationKeys, tick),
                .scale = track_of(channel.mScalingKeys, channel.mNumScalingKeys, tick)};
    }
    std::vector<PartMotion> parts;
    for (std::size_t i = 0; i < node.parts.size(); ++i) {
        const auto channel = channels.find(i);
        parts.emplace_back(*node.parts[i], channel == channels.end() ? nullptr : channel->second);
    }
    return sampled_chain(parts, tick);
}

/// Returns whether a channel of morph weights is that of the mesh. It names the node, followed by * and a number in FBX
/// files, or the mesh.
bool moves_weights(const aiMeshMorphAnim& channel, const Scene& scene, const SceneMesh& placed) {
    const std::string_view name(channel.mName.data, channel.mName.length);
    const std::string_view node = name.substr(0, name.rfind('*'));
    return node == scene.nodes[static_cast<std::size_t>(placed.node)].name || name == placed.mesh->mName.C_Str();
}

/// The weights of one morph target: pairs of time and weight. A key names only some of the targets.
using WeightKeys = std::vector<std::pair<double, double>>;

double weight_at(const WeightKeys& keys, double time, double at_rest) {
    if (keys.empty()) return at_rest;
    const auto after = std::ranges::upper_bound(keys, time, {}, &WeightKeys::value_type::first);
    if (after == keys.begin()) return keys.front().second;
    if (after == keys.end()) return keys.back().second;
    const auto& [before, weight] = *(after - 1);
    return weight + (after->second - weight) * (time - before) / (after->first - before);
}

std::vector<WeightKeys> weight_keys(const aiMeshMorphAnim& channel, std::size_t targets, double tick) {
    std::vector<WeightKeys> keys(targets);
    for (unsigned k = 0; k < channel.mNumKeys; ++k) {
        const aiMeshMorphKey& key = channel.mKeys[k];
        for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i)
            if (key.mValues[i] < targets && std::isfinite(key.mTime))
                keys[key.mValues[i]].emplace_back(key.mTime * tick, key.mWeights[i]);
    }
    for (WeightKeys& of_target : keys) std::ranges::stable_sort(of_target, {}, &WeightKeys::value_type::first);
    return keys;
}

}  // namespace

std::vector<NodeTracks> node_tracks(const Scene& scene, const aiAnimation& animation) {
    std::map<int, Channels> channels;
    for (unsigned i = 0; i < animation.mNumChannels; ++i) {
        const auto found = scene.part_of_name.find(animation.mChannels[i]->mNodeName.C_Str());
        if (found == scene.part_of_name.end()) continue;
        channels[found->second.first][found->second.second] = animation.mChannels[i];
    }
    std::vector<NodeTracks> tracks;
    for (const auto& [node, of_parts] : channels) {
        tracks.push_back(tracks_of(scene.nodes[static_cast<std::size_t>(node)], of_parts, seconds_per_tick(animation)));
        tracks.back().node = node;
    }
    return tracks;
}

Track weight_track(const Scene& scene, const aiAnimation& animation, const SceneMesh& placed) {
    Track track;
    const std::vector<float> at_rest = rest_weights(scene, *placed.mesh);
    for (unsigned c = 0; c < animation.mNumMorphMeshChannels && !at_rest.empty(); ++c) {
        const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[c];
        if (!moves_weights(channel, scene, placed)) continue;
        const std::vector<WeightKeys> keys = weight_keys(channel, at_rest.size(), seconds_per_tick(animation));
        std::vector<double> times;
        for (const WeightKeys& of_target : keys)
            for (const auto& key : of_target) times.push_back(key.first);
        std::ranges::sort(times);
        times.erase(std::unique(times.begin(), times.end()), times.end());
        for (const double time : times) {
            std::vector<float> weights;
            for (std::size_t t = 0; t < keys.size(); ++t)
                weights.push_back(static_cast<float>(weight_at(keys[t], time, at_rest[t])));
            add_key(track, time, weights);
        }
        return track;
    }
    return track;
}

}  // namespace exemplar::import
