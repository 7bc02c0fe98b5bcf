// Records from which no model can be identified are refused, with the place and the cure.
#include <gmock/gmock.h>

#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::HasSubstr;

TEST(IdentifyRefuses, FewerThanEightSamplesAreRefusedWithTheirNumber) {
    const Error error = refusal(simulate(even_times(3, 1), 0, 0, {{1, 1}}, first_order(1, 2, 0)));
    EXPECT_EQ(error.kind, ErrorKind::not_identifiable);
    EXPECT_THAT(error.message, HasSubstr("has 3 usable samples"));
    EXPECT_EQ(refusal(Record{}).kind, ErrorKind::not_identifiable);
}

TEST(IdentifyRefuses, ConstantMeasurementIsRefused) {
    const Error error = refusal(simulate(even_times(100, 1), 0, 21.5, {{10, 1}}, first_order(0, 2, 0)));
    EXPECT_EQ(error.kind, ErrorKind::not_identifiable);
    EXPECT_THAT(error.message, HasSubstr("y never moves (it is 21.5"));
}

TEST(IdentifyRefuses, StepInTheLastSamplesIsRefused) {
    Record record = simulate(even_times(100, 1), 0, 20, {{97, 1}}, first_order(1, 12, 3));
    add_noise(record, 0.01, 6);
    const Error error = refusal(record);
    EXPECT_EQ(error.kind, ErrorKind::not_identifiable);
    EXPECT_THAT(error.message, HasSubstr("with 2 sample(s) after it"));
}

TEST(IdentifyRefuses, MeasurementThatIgnoresTheInputIsRefused) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        Record record = simulate(even_times(300, 1), 0, 20, {{100, 1}}, first_order(0, 1, 0));
        add_noise(record, 0.5, 40 + seed, seed % 2 ? 0.9 : 0);
        const Error error = refusal(record);
        EXPECT_EQ(error.kind, ErrorKind::not_identifiable) << seed;
        EXPECT_THAT(error.message, HasSubstr("does not respond"));
    }
}

TEST(IdentifyRefuses, RefusalOfAnAskedModelNamesItAndItsAlternative) {
    Record record = simulate(even_times(300, 1), 0, 20, {{100, 1}}, first_order(0, 1, 0));
    add_noise(record, 0.5, 40);
    IdentifyOptions options;
    options.model = ModelChoice::ipdt;
    const Error error = refusal(record, options);
    EXPECT_EQ(error.kind, ErrorKind::not_identifiable);
    EXPECT_EQ(error.where, "identify/model");
    EXPECT_THAT(error.message, HasSubstr("No ipdt model explains y"));
    EXPECT_THAT(error.message, HasSubstr("Use model auto"));
}

TEST(IdentifyRefuses, ColumnsOfUnequalLengthAreAnInvalidArgument) {
    Record record = simulate(even_times(100, 1), 0, 0, {{10, 1}}, first_order(1, 12, 3));
    record.y.pop_back();
    const Error error = refusal(record);
    EXPECT_EQ(error.kind, ErrorKind::invalid_argument);
    EXPECT_THAT(error.message, HasSubstr("100, 100 and 99 values"));
}

TEST(IdentifyRefuses, ARecordPastedTwiceIsAnInvalidArgument) {
    Record record = simulate(even_times(200, 0.5), 0, 0, {{5, 1}}, first_order(2, 8, 1.3));
    for (auto* column : {&record.t, &record.u, &record.y}) {
        const std::vector<double> once = *column;
        column->insert(column->end(), once.begin(), once.end());
    }
    const Error error = refusal(record);
    EXPECT_EQ(error.kind, ErrorKind::invalid_argument);
    EXPECT_THAT(error.message, HasSubstr("Times run backward in 199 of 400 rows (first at row 200)"));
}

TEST(IdentifyRefuses, RelayFormulasRefuseARecordWithoutARelay) {
    IdentifyOptions options;
    options.method = IdentifyMethod::relay_fourier;
    const Error error = refusal(simulate(even_times(100, 1), 0, 0, {{10, 1}}, first_order(1, 12, 3)), options);
    EXPECT_EQ(error.kind, ErrorKind::not_identifiable);
    EXPECT_EQ(error.where, "record/u");
    EXPECT_THAT(error.message, HasSubstr("output_error"));
}

}  // namespace
}  // namespace tunewright
