// Columns that keep each value until the next one.
#include "engine/identification/record/held_column.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tunewright {
namespace {

TEST(HeldColumn, HasTheChangesInTheOrderOfTime) {
    const double none = std::nan("");
    const HeldColumn column = held_column({5, 1, 2, none, 3, 4, 4}, {9, 7, 7, 1, none, 8, 9});
    EXPECT_EQ(column.time, (std::vector<double>{1, 4, 4}));
    EXPECT_EQ(column.value, (std::vector<double>{7, 8, 9}));
    EXPECT_TRUE(held_column({1, 2}, {}).empty());
}

TEST(HeldColumn, IsTheLastValueAtEachSample) {
    Record record;
    for (int k = 0; k < 20; ++k) {
        record.t.push_back(100 + 3 * k);
        record.u.push_back(k < 5 ? 1 : 2);
        record.y.push_back(k < 6 ? 40 + 0.01 * (k % 3) : 40 + 0.5 * (k - 6));
    }
    const auto clean = clean_record(record);
    ASSERT_TRUE(clean);
    const std::vector<double> at = at_samples({{103, 130, 130}, {4, 5, 6}}, *clean);
    ASSERT_EQ(at.size(), 20u);
    for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(at[k], record.t[k] < 130 ? 4 : 6) << k;
    EXPECT_TRUE(at_samples({}, *clean).empty());
}

}  // namespace
}  // namespace tunewright
