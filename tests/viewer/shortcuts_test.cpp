#include "apps/viewer/controls/shortcuts.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace exemplar {
namespace {

TEST(Shortcuts, NoKeyDoesTwoThings) {
    std::set<std::tuple<int, bool, KeyMode>> keys;
    for (const Shortcut& shortcut : shortcuts())
        EXPECT_TRUE(keys.emplace(shortcut.key, shortcut.control, shortcut.mode).second) << shortcut.keys;
}

TEST(Shortcuts, EveryActionHasAKeyThatIsShown) {
    for (int action = 0; action <= static_cast<int>(Action::open_suggested); ++action)
        EXPECT_FALSE(keys_of(static_cast<Action>(action)).empty()) << action;
}

TEST(Shortcuts, WhatIsShownIsWhatTheKeyDoes) {
    for (const Shortcut& shortcut : shortcuts()) {
        EXPECT_FALSE(shortcut.keys.empty());
        EXPECT_FALSE(shortcut.what.empty());
        const bool painting = shortcut.mode == KeyMode::painting;
        EXPECT_EQ(action_of(shortcut.key, shortcut.control, painting), shortcut.action);
        EXPECT_EQ(shortcut.keys.starts_with("Ctrl+"), shortcut.control) << shortcut.keys;
    }
}

TEST(Shortcuts, KeysOfPaintingComeFirstWhilePainting) {
    EXPECT_EQ(action_of('1', false, true), Action::label_1);
    EXPECT_EQ(action_of('1', false, false), Action::front);
    EXPECT_EQ(action_of('F', false, true), Action::fit);
    EXPECT_EQ(action_of('Z', true, false), std::nullopt);
}

TEST(Shortcuts, OtherKeysDoNothing) {
    EXPECT_EQ(action_of(-1, false), std::nullopt);
    EXPECT_EQ(action_of('S', true), Action::save_png);
    EXPECT_EQ(action_of('S', false), Action::next_light);
    EXPECT_EQ(action_of('F', true), std::nullopt);
}

}  // namespace
}  // namespace exemplar
