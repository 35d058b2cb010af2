// Normalization Form C, against values of the Unicode Standard and its Annex 15.

#include "core/base/unicode.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

TEST(Unicode, WhatIsComposedStaysAsItIs) {
    for (const char* text : {"", "plain ASCII | : #", "Gr\u00fcn", "\u00e9", "\u4e2d\u6587", "\uac00\ud7a3", "\U0001f600"})
        EXPECT_EQ(composed(text), text);
}

TEST(Unicode, MarksJoinTheirLetters) {
    EXPECT_EQ(composed("e\u0301"), "\u00e9");
    EXPECT_EQ(composed("Gru\u0308n"), "Gr\u00fcn");
    EXPECT_EQ(composed("A\u030a"), "\u00c5");
    EXPECT_EQ(composed("\u212b"), "\u00c5");        // the sign for the unit of length
    EXPECT_EQ(composed("\u2126"), "\u03a9");        // ohm
    EXPECT_EQ(composed("s\u0323\u0307"), "\u1e69");  // two marks, in order and not
    EXPECT_EQ(composed("s\u0307\u0323"), "\u1e69");
    EXPECT_EQ(composed("\u1e9b\u0323"), "\u1e9b\u0323");
    EXPECT_EQ(composed("d\u0307\u0323"), "\u1e0d\u0307");
    EXPECT_EQ(composed("\U0001d15e"), "\U0001d157\U0001d165");  // an exclusion: taken apart, never joined
    EXPECT_EQ(composed("\u0958"), "\u0915\u093c");
    EXPECT_EQ(composed("\uf900"), "\u8c48");
}

TEST(Unicode, AMarkOfTheSameClassBetweenStandsInTheWay) {
    EXPECT_EQ(composed("a\u0315\u0301"), "\u00e1\u0315");        // 232 before 230: sorted, then joined
    EXPECT_EQ(composed("a\u0302\u0302"), "\u00e2\u0302");
    EXPECT_EQ(composed("a\u0305\u0301"), "a\u0305\u0301");
    EXPECT_EQ(composed("\u0301e"), "\u0301e");                    // a mark without a letter
}

TEST(Unicode, HangulIsMadeByArithmetic) {
    EXPECT_EQ(composed("\u1112\u1161\u11ab"), "\ud55c");
    EXPECT_EQ(composed("\u1112\u1161"), "\ud558");
    EXPECT_EQ(composed("\ud558\u11ab"), "\ud55c");
    EXPECT_EQ(composed("\ud55c\u11ab"), "\ud55c\u11ab");
    EXPECT_EQ(composed("\u1161\u11ab"), "\u1161\u11ab");
}

}  // namespace
}  // namespace penumbra
