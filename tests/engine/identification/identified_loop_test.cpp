// The rows that identification hands on with the model of a loop.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/identification/closed_loop/loop_record.h"
#include "engine/identification/identify.h"
#include "tests/records/closed_loop_records.h"

namespace tunewright {
namespace {

TEST(IdentifiedLoop, HasTheRowsTheSetPointAndTheModeOfTheRecord) {
    int loops = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        Record record = testing::simulated_loop(seed, testing::LoopTest::set_points_with_r).record;
        for (auto* column : {&record.t, &record.u, &record.y, &record.r})
            column->resize(std::min<std::size_t>(400, column->size()));
        for (std::size_t i = 0; i < record.t.size(); ++i) record.automatic.push_back(i % 100 != 7);
        const auto model = identify(record, {}, {});
        if (!model || !model->data_quality.closed_loop) continue;
        ++loops;
        ASSERT_TRUE(model->loop);
        const IdentifiedLoop& loop = *model->loop;
        const RecordScale& scale = loop.clean.scale;
        const std::vector<double> r = at_samples(loop.set_point, loop.clean),
                                  automatic = at_samples(loop.automatic, loop.clean);
        ASSERT_EQ(r.size(), loop.clean.t.size());
        ASSERT_EQ(loop.clean.row.size(), loop.clean.t.size());
        for (std::size_t i = 0; i < r.size(); ++i) {
            const auto row = static_cast<std::size_t>(loop.clean.row[i]);
            EXPECT_EQ(r[i], record.r[row]);
            EXPECT_EQ(automatic[i] != 0, bool(record.automatic[row]));
            EXPECT_NEAR(scale.y_origin + scale.y_scale * loop.clean.y[i], record.y[row], 1e-9 * scale.y_scale);
        }
    }
    EXPECT_GE(loops, 1);
}

TEST(IdentifiedLoop, IsMissingForAnOpenLoopTest) {
    const auto model = identify(testing::open_loop_test(3001).record, {}, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_FALSE(model->loop);
}

TEST(IdentifiedLoop, AModeThatIsNotAsLongAsTheRecordIsRefused) {
    Record record = testing::simulated_loop(1, testing::LoopTest::set_points_with_r).record;
    record.automatic.assign(record.t.size() - 1, true);
    const auto model = identify(record, {}, {});
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().kind, ErrorKind::invalid_argument);
    EXPECT_EQ(model.error().where, "record/mode");
}

}  // namespace
}  // namespace tunewright
