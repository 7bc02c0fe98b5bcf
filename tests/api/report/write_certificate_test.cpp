#include "api/certificate/write_certificate.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace tunewright::api {
namespace {

TEST(WriteCertificate, TheFirstLineHasTheClaimAndEachLeafALineThatReadsBackExactly) {
    const auto plant = LinearPlant::make(Fopdt{.K = 1, .T = 100, .L = 1, .uncertainty = {}});
    const IdealPid pid{.Kp = 30, .Ti = 12, .filter = {}};
    const auto problem = certificate_problem(*plant, pid, 1.5, 1.6, 0.45, false);
    ASSERT_TRUE(problem);
    CertifyOptions options;
    options.keep_leaves = true;
    options.max_boxes = 200;
    const auto certificate = certify(*problem, options, {});
    ASSERT_TRUE(certificate);
    ASSERT_GT(certificate->leaves.size(), 10U);

    std::istringstream text(write_certificate(*certificate));
    std::string line;
    std::vector<nlohmann::json> lines;
    while (std::getline(text, line)) lines.push_back(nlohmann::json::parse(line));
    ASSERT_EQ(lines.size(), certificate->leaves.size() + 1);
    const auto& head = lines[0];
    EXPECT_EQ(head.at("certificate"), 1);
    EXPECT_EQ(head.at("structure"), "pi");
    EXPECT_EQ(head.at("plant").at("den").get<std::vector<double>>(), problem->plant.den);
    EXPECT_EQ(head.at("plant").at("L"), 1);
    EXPECT_EQ(head.at("Ms"), 1.5);
    EXPECT_EQ(head.at("Mt"), 1.6);
    EXPECT_EQ(head.at("goal").get<double>(), certificate->lower);
    EXPECT_EQ(head.at("leaves"), certificate->leaves.size());
    for (std::size_t i = 0; i < certificate->leaves.size(); ++i) {
        const auto& leaf = certificate->leaves[i];
        const auto& written = lines[i + 1];
        EXPECT_EQ(written.at("reason"), tunewright::to_string(leaf.reason));
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(written.at("low").at(k).get<double>(), leaf.box.low[k]);
            EXPECT_EQ(written.at("high").at(k).get<double>(), leaf.box.high[k]);
        }
        const bool limit = leaf.reason == LeafReason::sensitivity || leaf.reason == LeafReason::complementary;
        EXPECT_EQ(written.contains("omega"), limit);
        EXPECT_EQ(written.contains("cuts"), leaf.reason == LeafReason::bound || leaf.reason == LeafReason::empty);
        EXPECT_EQ(written.contains("phi"), leaf.reason == LeafReason::bound);
    }
}

}  // namespace
}  // namespace tunewright::api
