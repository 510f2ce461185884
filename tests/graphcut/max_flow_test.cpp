#include "host/graphcut/max_flow.h"

#include <gtest/gtest.h>

#include <string>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false alarms in Boost's iterators
#endif
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

using Edge = std::array<std::uint32_t, 2>;

struct FlowProblem {
    std::size_t nodes = 0;
    std::vector<Edge> edges;
    std::vector<double> forward, backward, from_source, to_sink;

    void add_edge(std::size_t a, std::size_t b, double ab, double ba) {
        edges.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
        forward.push_back(ab);
        backward.push_back(ba);
    }
};

/// Capacities drawn from [0, 10], whole if `integers`, zero with probability `zeros`.
struct Capacities {
    Random& random;
    bool integers;
    double zeros;

    double draw() {
        if (random.uniform() < zeros) return 0.0;
        const double value = random.uniform(0.0, 10.0);
        return integers ? std::floor(value) : value;
    }
};

void draw_terminals(FlowProblem& problem, Capacities capacities) {
    for (std::size_t i = 0; i < problem.nodes; ++i) {
        problem.from_source.push_back(capacities.draw());
        problem.to_sink.push_back(capacities.draw());
    }
}

FlowProblem random_graph(std::size_t nodes, std::size_t edges, Capacities capacities) {
    FlowProblem problem;
    problem.nodes = nodes;
    for (std::size_t e = 0; e < edges; ++e) {
        const std::size_t a = capacities.random.index(nodes), b = capacities.random.index(nodes);
        const double ab = capacities.draw();  // one draw per statement: arguments have no order of evaluation
        problem.add_edge(a, b, ab, capacities.draw());
    }
    draw_terminals(problem, capacities);
    return problem;
}

FlowProblem grid_graph(std::size_t width, std::size_t height, Capacities capacities) {
    FlowProblem problem;
    problem.nodes = width * height;
    for (std::size_t i = 0; i < problem.nodes; ++i) {
        if (i % width + 1 < width) {
            const double ab = capacities.draw();
            problem.add_edge(i, i + 1, ab, capacities.draw());
        }
        if (i + width < problem.nodes) {
            const double ab = capacities.draw();
            problem.add_edge(i, i + width, ab, capacities.draw());
        }
    }
    draw_terminals(problem, capacities);
    return problem;
}

double reference_flow(const FlowProblem& problem) {
    using namespace boost;
    using Traits = adjacency_list_traits<vecS, vecS, directedS>;
    using Graph = adjacency_list<
        vecS, vecS, directedS,
        property<vertex_index_t, long,
                 property<vertex_color_t, default_color_type,
                          property<vertex_distance_t, long, property<vertex_predecessor_t, Traits::edge_descriptor>>>>,
        property<edge_capacity_t, double,
                 property<edge_residual_capacity_t, double, property<edge_reverse_t, Traits::edge_descriptor>>>>;
    Graph graph(problem.nodes + 2);
    const std::size_t source = problem.nodes, sink = problem.nodes + 1;
    const auto add = [&](std::size_t a, std::size_t b, double ab, double ba) {
        const auto there = boost::add_edge(a, b, graph).first;
        const auto back = boost::add_edge(b, a, graph).first;
        put(edge_capacity, graph, there, ab);
        put(edge_capacity, graph, back, ba);
        put(edge_reverse, graph, there, back);
        put(edge_reverse, graph, back, there);
    };
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        if (problem.edges[e][0] == problem.edges[e][1]) continue;
        add(problem.edges[e][0], problem.edges[e][1], problem.forward[e], problem.backward[e]);
    }
    for (std::size_t i = 0; i < problem.nodes; ++i) {
        add(source, i, problem.from_source[i], 0.0);
        add(i, sink, problem.to_sink[i], 0.0);
    }
    return boykov_kolmogorov_max_flow(graph, source, sink);
}

void solve(const FlowProblem& problem, MaxFlow& flow) {
    std::vector<double> capacity(flow.arcs(), 0.0);
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        const auto [there, back] = flow.arcs_of_edge(e);
        if (there == back) continue;  // from a node to itself
        capacity[there] = problem.forward[e];
        capacity[back] = problem.backward[e];
    }
    const auto terminal = [&](std::size_t node) { return problem.from_source[node] - problem.to_sink[node]; };
    std::vector<MaxFlow::Node> start;
    for (MaxFlow::Node i = 0; i < problem.nodes; ++i)
        if (terminal(i) < 0) start.push_back(i);
    flow.solve(start, [&](MaxFlow::Node node) {
        flow.set_node(node, terminal(node));
        for (auto arc = flow.first_arc(node); arc < flow.first_arc(node + 1); ++arc) flow.set_arc(arc, capacity[arc]);
    });
}

double cut_cost(const FlowProblem& problem, const MaxFlow& flow) {
    double cost = 0.0;
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        const bool a = flow.on_sink_side(problem.edges[e][0]), b = flow.on_sink_side(problem.edges[e][1]);
        if (!a && b) cost += problem.forward[e];
        if (a && !b) cost += problem.backward[e];
    }
    for (std::size_t i = 0; i < problem.nodes; ++i) {
        cost += flow.on_sink_side(i) ? problem.from_source[i] : problem.to_sink[i];
    }
    return cost;
}

/// The cost of the cut equals the reference's flow: by duality both are then optimal.
void expect_solved(const FlowProblem& problem, MaxFlow& flow, bool integers, const std::string& what) {
    solve(problem, flow);
    const double expected = reference_flow(problem);
    EXPECT_NEAR(cut_cost(problem, flow), expected, integers ? 0.0 : 1e-9 * (1.0 + expected)) << what;
}

TEST(MaxFlow, EqualsTheReferenceOnRandomGraphs) {
    Random random(7);
    for (std::size_t trial = 0; trial < 400; ++trial) {
        const bool integers = trial % 2 == 0;
        const Capacities capacities{random, integers, trial % 3 == 0 ? 0.6 : 0.1};
        const std::size_t nodes = 1 + random.index(60);
        const std::size_t edges = trial % 5 == 0 ? nodes * 12 : random.index(3 * nodes + 1);
        const FlowProblem problem = random_graph(nodes, edges, capacities);
        MaxFlow flow(problem.nodes, problem.edges);
        expect_solved(problem, flow, integers, "random graph " + std::to_string(trial));
    }
}

TEST(MaxFlow, EqualsTheReferenceOnGrids) {
    Random random(11);
    for (std::size_t trial = 0; trial < 60; ++trial) {
        const bool integers = trial % 2 == 0;
        const std::size_t width = 1 + random.index(30), height = 1 + random.index(30);
        FlowProblem problem = grid_graph(width, height, {random, integers, 0.2});
        // Few, strong terminals make long paths and deep trees.
        for (std::size_t i = 0; i < problem.nodes; ++i) {
            const double keep = trial % 3 == 0 ? (random.uniform() < 0.05 ? 20.0 : 0.0) : 1.0;
            problem.from_source[i] *= keep;
            problem.to_sink[i] *= keep;
        }
        MaxFlow flow(problem.nodes, problem.edges);
        expect_solved(problem, flow, integers, "grid " + std::to_string(trial));
    }
}

TEST(MaxFlow, IsReusableWithOtherCapacities) {
    Random random(3);
    FlowProblem problem = grid_graph(12, 9, {random, false, 0.1});
    MaxFlow flow(problem.nodes, problem.edges);
    for (std::size_t trial = 0; trial < 20; ++trial) {
        Capacities capacities{random, false, 0.3};
        for (double& value : problem.forward) value = capacities.draw();
        for (double& value : problem.backward) value = capacities.draw();
        for (double& value : problem.from_source) value = capacities.draw();
        expect_solved(problem, flow, false, "trial " + std::to_string(trial));
    }
}

TEST(MaxFlow, PutsUnreachedNodesOnTheSourceSide) {
    FlowProblem problem{4, {}, {}, {}, {0, 0, 0, 0}, {3, 0, 0, 0}};
    problem.add_edge(0, 1, 0, 0);
    problem.add_edge(2, 2, 5, 5);
    MaxFlow flow(problem.nodes, problem.edges);
    solve(problem, flow);
    EXPECT_TRUE(flow.on_sink_side(0));
    for (std::size_t i = 1; i < 4; ++i) EXPECT_FALSE(flow.on_sink_side(i));
}

TEST(MaxFlow, HandlesParallelEdgesAndNoNodes) {
    FlowProblem problem{2, {}, {}, {}, {10, 0}, {0, 10}};
    problem.add_edge(0, 1, 1, 0);
    problem.add_edge(0, 1, 2, 0);
    problem.add_edge(1, 0, 100, 4);
    MaxFlow flow(problem.nodes, problem.edges);
    solve(problem, flow);
    EXPECT_FALSE(flow.on_sink_side(0));
    EXPECT_TRUE(flow.on_sink_side(1));
    EXPECT_EQ(cut_cost(problem, flow), 7);
    MaxFlow empty(0, {});
    solve({}, empty);
    EXPECT_TRUE(empty.reached().empty());
}

TEST(MaxFlow, RefusesEdgesBeyondTheNodes) {
    const std::vector<Edge> edges{{0, 2}};
    EXPECT_THROW(MaxFlow(2, edges), UsageError);
}

}  // namespace
}  // namespace exemplar
