#include "host/core/json_text.h"

#include <gtest/gtest.h>

namespace exemplar {
namespace {

TEST(JsonText, IsReadBack) {
    const nlohmann::json json{{"b", 1.5}, {"a", {1, "x"}}};
    EXPECT_EQ(json_text(json), R"({"a":[1,"x"],"b":1.5})");
    EXPECT_EQ(parse_json(json_text(json)), json);
    EXPECT_EQ(parse_json(json_text(json, 2)), json);
}

TEST(JsonText, ReplacesBytesThatAreNoUtf8) {
    EXPECT_EQ(json_text(nlohmann::json("a\xFF")), "\"a\xEF\xBF\xBD\"");
}

TEST(JsonText, OfOrderedMembersKeepsTheirOrderAndEscapesOnDemand) {
    const nlohmann::ordered_json json{{"b", "\xC3\xA9"}, {"a", 1}};
    EXPECT_EQ(ordered_json_text(json), "{\"b\":\"\xC3\xA9\",\"a\":1}");
    EXPECT_EQ(ordered_json_text(json, -1, true), "{\"b\":\"\\u00e9\",\"a\":1}");
}

TEST(ParseJson, ThrowsOrDiscardsWhatIsNoJson) {
    EXPECT_THROW(parse_json("{"), nlohmann::json::parse_error);
    EXPECT_TRUE(parse_json("{", nullptr, false).is_discarded());
    EXPECT_EQ(parse_json("/* one */ 1", nullptr, true, true), 1);
}

TEST(ParseJson, LeavesOutWhatTheCallbackDiscards) {
    const auto is_shallow = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) { return depth < 2; };
    EXPECT_EQ(parse_json(R"({"a":1,"b":{"c":{}}})", is_shallow), parse_json(R"({"a":1,"b":{}})"));
}

}  // namespace
}  // namespace exemplar
