// The hierarchy of a file, and its meshes at rest.
#include "apps/import/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace exemplar::import {
namespace {

/// Returns NAME for the parts NAME_$AssimpFbx$_PART of a chain, and for the node NAME itself.
std::string chain_name(const aiNode& node) {
    const std::string name = node.mName.C_Str();
    return name.substr(0, name.find("_$AssimpFbx$"));
}

/// Returns whether the node and its only child belong to one chain.
bool continues(const aiNode& node) {
    return node.mNumChildren == 1 && node.mNumMeshes == 0 &&
           std::string(node.mName.C_Str()).find("_$AssimpFbx$") != std::string::npos &&
           chain_name(node) == chain_name(*node.mChildren[0]);
}

bool is_polygon(const aiFace& face) {
    return face.mNumIndices >= 3;
}

void check_face(const aiMesh& mesh, const aiFace& face) {
    for (unsigned i = 0; i < face.mNumIndices; ++i)
        if (face.mIndices[i] >= mesh.mNumVertices)
            throw std::runtime_error("a face names vertex " + std::to_string(face.mIndices[i]) + " of " +
                                     std::to_string(mesh.mNumVertices));
}

class SceneReader {
  public:
    SceneReader(const aiScene& source, bool has_rest_weights) {
        scene_.source = &source;
        scene_.has_rest_weights = has_rest_weights;
    }

    Scene read() {
        add_node(*scene_.source->mRootNode, -1, 0);
        check_faces();
        std::size_t jointless = 0;
        for (SceneMesh& placed : scene_.meshes) {
            jointless += !find_joints(placed);
            mark_carriers(placed.node);
            for (const int joint : placed.joints) mark_carriers(joint);
        }
        if (jointless)
            scene_.warnings.push_back("the skins of " + std::to_string(jointless) +
                                      " meshes name joints that the file lacks; the meshes follow their nodes");
        return std::move(scene_);
    }

  private:
    static constexpr int k_deepest = 1000;

    void add_node(const aiNode& first, int parent, int depth) {
        SceneNode node{
            .name = {}, .parent = parent, .parts = {&first}, .local = Matrix(first.mTransformation), .world = {}};
        while (continues(*node.parts.back())) {
            node.parts.push_back(node.parts.back()->mChildren[0]);
            node.local *= Matrix(node.parts.back()->mTransformation);
        }
        depth += static_cast<int>(node.parts.size());
        if (depth > k_deepest) throw std::runtime_error("its nodes are nested too deep");
        const int index = static_cast<int>(scene_.nodes.size());
        const aiNode& last = *node.parts.back();
        node.name = last.mName.C_Str();
        node.world = parent < 0 ? node.local : scene_.nodes[static_cast<std::size_t>(parent)].world * node.local;
        for (std::size_t part = 0; part < node.parts.size(); ++part)
            scene_.part_of_name.try_emplace(node.parts[part]->mName.C_Str(), index, part);
        for (unsigned i = 0; i < last.mNumMeshes; ++i)
            scene_.meshes.push_back({scene_.source->mMeshes[last.mMeshes[i]], index, {}});
        scene_.nodes.push_back(std::move(node));
        for (unsigned i = 0; i < last.mNumChildren; ++i) add_node(*last.mChildren[i], index, depth);
    }

    void check_faces() {
        std::size_t faces = 0, left_out = 0;
        for (const SceneMesh& placed : scene_.meshes)
            for (unsigned f = 0; f < placed.mesh->mNumFaces; ++f) {
                check_face(*placed.mesh, placed.mesh->mFaces[f]);
                ++(is_polygon(placed.mesh->mFaces[f]) ? faces : left_out);
            }
        if (!faces) throw std::runtime_error("no node has a mesh with faces");
        if (left_out) scene_.warnings.push_back(std::to_string(left_out) + " points or lines were left out");
    }

    void mark_carriers(int node) {
        for (; node >= 0 && !scene_.nodes[static_cast<std::size_t>(node)].carries_mesh;
             node = scene_.nodes[static_cast<std::size_t>(node)].parent)
            scene_.nodes[static_cast<std::size_t>(node)].carries_mesh = true;
    }

    /// Finds the nodes of the bones; returns false, and leaves the mesh without joints, if one is missing.
    bool find_joints(SceneMesh& placed) const {
        for (unsigned b = 0; b < placed.mesh->mNumBones; ++b) {
            const auto found = scene_.part_of_name.find(placed.mesh->mBones[b]->mName.C_Str());
            if (found == scene_.part_of_name.end()) {
                placed.joints.clear();
                return false;
            }
            placed.joints.push_back(found->second.first);
        }
        return true;
    }

    Scene scene_;
};

/// Computes the matrix by which a joint moves the vertices of a mesh at rest.
Matrix bone_matrix(const Scene& scene, const SceneMesh& placed, std::size_t bone) {
    return scene.nodes[static_cast<std::size_t>(placed.joints[bone])].world *
           Matrix(placed.mesh->mBones[bone]->mOffsetMatrix);
}

std::vector<Position> morphed(const Scene& scene, const aiMesh& mesh) {
    std::vector<Position> positions;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        positions.emplace_back(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z);
    const std::vector<float> weights = rest_weights(scene, mesh);
    for (unsigned t = 0; t < mesh.mNumAnimMeshes; ++t) {
        if (weights[t] == 0) continue;
        const std::vector<aiVector3D> offsets = target_offsets(mesh, t);
        for (std::size_t v = 0; v < offsets.size(); ++v)
            positions[v] += Position(offsets[v].x, offsets[v].y, offsets[v].z) * double{weights[t]};
    }
    return positions;
}

}  // namespace

Scene read_scene(const aiScene& source, bool has_rest_weights) {
    return SceneReader(source, has_rest_weights).read();
}

std::vector<std::vector<std::uint32_t>> polygons_of(const aiMesh& mesh, bool turned) {
    std::vector<std::vector<std::uint32_t>> polygons;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (!is_polygon(face)) continue;
        polygons.emplace_back(face.mIndices, face.mIndices + face.mNumIndices);
        if (turned) std::ranges::reverse(polygons.back());
    }
    return polygons;
}

bool has_motion(const Scene& scene) {
    const auto moves_mesh = [&](const aiNodeAnim* channel) {
        const auto found = scene.part_of_name.find(channel->mNodeName.C_Str());
        return found != scene.part_of_name.end() &&
               scene.nodes[static_cast<std::size_t>(found->second.first)].carries_mesh;
    };
    for (unsigned i = 0; i < scene.source->mNumAnimations; ++i) {
        const aiAnimation& animation = *scene.source->mAnimations[i];
        if (std::any_of(animation.mChannels, animation.mChannels + animation.mNumChannels, moves_mesh)) return true;
    }
    return std::ranges::any_of(scene.meshes, [](const SceneMesh& placed) {
        return !placed.joints.empty() || placed.mesh->mNumAnimMeshes > 0;
    });
}

std::vector<aiVector3D> target_offsets(const aiMesh& mesh, unsigned target) {
    const aiAnimMesh& moved = *mesh.mAnimMeshes[target];
    if (!moved.mVertices || moved.mNumVertices != mesh.mNumVertices) return {};
    std::vector<aiVector3D> offsets(moved.mVertices, moved.mVertices + moved.mNumVertices);
    if (mesh.mMethod != aiMorphingMethod_MORPH_RELATIVE)  // COLLADA's RELATIVE targets are offsets
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) offsets[v] -= mesh.mVertices[v];
    return offsets;
}

std::vector<float> rest_weights(const Scene& scene, const aiMesh& mesh) {
    std::vector<float> weights(mesh.mNumAnimMeshes, 0);
    for (unsigned t = 0; t < mesh.mNumAnimMeshes && scene.has_rest_weights; ++t)
        if (std::isfinite(mesh.mAnimMeshes[t]->mWeight)) weights[t] = mesh.mAnimMeshes[t]->mWeight;
    return weights;
}

std::vector<std::vector<Influence>> influences_of(const aiMesh& mesh) {
    std::vector<std::vector<Influence>> influences(mesh.mNumVertices);
    for (unsigned b = 0; b < mesh.mNumBones; ++b)
        for (unsigned i = 0; i < mesh.mBones[b]->mNumWeights; ++i) {
            const aiVertexWeight& entry = mesh.mBones[b]->mWeights[i];
            if (entry.mWeight > 0 && std::isfinite(entry.mWeight) && entry.mVertexId < mesh.mNumVertices)
                influences[entry.mVertexId].push_back({b, entry.mWeight});
        }
    for (std::vector<Influence>& row : influences)
        if (row.empty()) row.push_back({0, 1.0f});
    return influences;
}

std::vector<Position> positions_at_rest(const Scene& scene, const SceneMesh& placed) {
    std::vector<Position> positions = morphed(scene, *placed.mesh);
    if (placed.joints.empty()) {
        const Matrix& world = scene.nodes[static_cast<std::size_t>(placed.node)].world;
        for (Position& p : positions) p = world * p;
        return positions;
    }
    std::vector<Matrix> bones;
    for (std::size_t b = 0; b < placed.joints.size(); ++b) bones.push_back(bone_matrix(scene, placed, b));
    const std::vector<std::vector<Influence>> influences = influences_of(*placed.mesh);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        Position sum;
        double weights = 0;
        for (const Influence& influence : influences[v]) {
            sum += (bones[influence.bone] * positions[v]) * double{influence.weight};
            weights += influence.weight;
        }
        positions[v] = sum / weights;
    }
    return positions;
}

bool is_mirrored(const Scene& scene, const SceneMesh& placed) {
    if (placed.joints.empty()) return scene.nodes[static_cast<std::size_t>(placed.node)].world.Determinant() < 0;
    double vote = 0;  // of the vertices
    for (std::size_t b = 0; b < placed.joints.size(); ++b) {
        const double vertices = placed.mesh->mBones[b]->mNumWeights;
        vote += bone_matrix(scene, placed, b).Determinant() < 0 ? -vertices : vertices;
    }
    return vote < 0;
}

}  // namespace exemplar::import
