#include "apps/viewer/controls/shortcuts.h"

#include <gtest/gtest.h>

#include <set>

namespace exemplar {
namespace {

TEST(Shortcuts, NoKeyDoesTwoThings) {
    std::set<std::pair<int, bool>> keys;
    for (const Shortcut& shortcut : shortcuts())
        EXPECT_TRUE(keys.emplace(shortcut.key, shortcut.control).second) << shortcut.keys;
}

TEST(Shortcuts, EveryActionHasAKeyThatIsShown) {
    for (int action = 0; action <= static_cast<int>(Action::quit); ++action)
        EXPECT_FALSE(keys_of(static_cast<Action>(action)).empty()) << action;
}

TEST(Shortcuts, WhatIsShownIsWhatTheKeyDoes) {
    for (const Shortcut& shortcut : shortcuts()) {
        EXPECT_FALSE(shortcut.keys.empty());
        EXPECT_FALSE(shortcut.what.empty());
        EXPECT_EQ(action_of(shortcut.key, shortcut.control), shortcut.action);
        EXPECT_EQ(shortcut.keys.starts_with("Ctrl+"), shortcut.control) << shortcut.keys;
    }
}

TEST(Shortcuts, OtherKeysDoNothing) {
    EXPECT_EQ(action_of(-1, false), std::nullopt);
    EXPECT_EQ(action_of('S', true), Action::save_png);
    EXPECT_EQ(action_of('S', false), Action::next_light);
    EXPECT_EQ(action_of('F', true), std::nullopt);
}

}  // namespace
}  // namespace exemplar
