// Text to paste: every template of the catalogue with its product's settings, and the rules of its placeholders.
#include "engine/controller/product/snippet.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <utility>

#include "engine/controller/product/typed.h"
#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines{""};
    for (const char c : text) {
        if (c == '\n')
            lines.emplace_back();
        else
            lines.back().push_back(c);
    }
    return lines;
}

/// The names of the placeholders of a template; "{{" is a brace.
std::vector<std::string> names_in(std::string_view text) {
    std::vector<std::string> names;
    for (std::size_t at = text.find('{'); at != text.npos; at = text.find('{', at + 1)) {
        if (text.substr(at).starts_with("{{"))
            ++at;
        else
            names.emplace_back(text.substr(at + 1, text.find_first_of("}|=", at) - at - 1));
    }
    return names;
}

Settings settings_for(const Product& product, const IdealPid& pid) {
    const auto converted = to_settings(product, pid, kContext, true);
    EXPECT_TRUE(converted) << product.id;
    return converted ? converted->settings : Settings{};
}

Product product_with(std::string_view text) {
    Product product = product_of("beckhoff_fb_ctrl_pid");
    product.snippets = {{"test", text}};
    return product;
}

std::string filled(std::string_view text, const Settings& settings, const Context& context = kContext) {
    const auto snippets = filled_snippets(product_with(text), settings, context);
    return snippets.empty() ? "" : snippets.front().text;
}

TEST(Snippets, EveryPlaceholderOfTheCatalogueIsASettingOrThePeriod) {
    std::size_t products = 0;
    for (const Product& product : catalogue()) {
        products += product.snippets.empty() ? 0 : 1;
        for (const Snippet& snippet : product.snippets)
            for (const std::string& name : names_in(snippet.text))
                EXPECT_TRUE(parameter_named(product, name) != nullptr || name == product.action.name ||
                            name.starts_with("sample_time_"))
                    << product.id << " " << name;
    }
    EXPECT_GT(products, 20U);
}

TEST(Snippets, HoldEverySettingOfTheExampleAsItIsTyped) {
    for (const Product& product : catalogue()) {
        const Settings& settings = product.example.settings;
        const auto snippets = filled_snippets(product, settings, context_of(product.example));
        ASSERT_EQ(snippets.size(), product.snippets.size()) << product.id;
        for (std::size_t i = 0; i < snippets.size(); ++i) {
            const std::string_view pattern = product.snippets[i].text;
            for (const std::string& name : names_in(pattern))
                EXPECT_THAT(names_in(snippets[i].text), Not(Contains(name))) << product.id;
            EXPECT_EQ(lines_of(snippets[i].text).size(), lines_of(pattern).size()) << product.id << ": a line is lost";
            for (const Setting& setting : settings) {
                if (pattern.find("{" + setting.name + "}") == pattern.npos) continue;
                EXPECT_THAT(snippets[i].text, HasSubstr(typed_text(product, setting))) << product.id;
            }
        }
    }
}

/// A proportional controller loses integral and derivative, but no snippet loses all of its lines, and no number is -0.
TEST(Snippets, ServeAProportionalControllerOfEitherSign) {
    for (const double Kp : {1.5, -1.5})
        for (const Product& product : catalogue()) {
            const auto snippets = filled_snippets(product, settings_for(product, {.Kp = Kp}), kContext);
            EXPECT_EQ(snippets.size(), product.snippets.size()) << product.id;
            for (const FilledSnippet& snippet : snippets) {
                EXPECT_THAT(lines_of(snippet.text), Not(Contains(HasSubstr("-0.00")))) << product.id;
                EXPECT_THAT(lines_of(snippet.text), Not(Contains(HasSubstr("nan")))) << product.id;
            }
        }
}

/// A positive and a negative gain are pasted differently: by the sign, or by the switch of the direction.
TEST(Snippets, OfEverySwitchedProductDifferByTheDirection) {
    for (const Product& product : catalogue()) {
        if (product.snippets.empty() || product.action.kind == Action::Kind::reverse_only) continue;
        const auto heats = filled_snippets(product, settings_for(product, {.Kp = 1.5, .Ti = 120}), kContext);
        const auto cools = filled_snippets(product, settings_for(product, {.Kp = -1.5, .Ti = 120}), kContext);
        ASSERT_EQ(heats.size(), cools.size()) << product.id;
        for (std::size_t i = 0; i < heats.size(); ++i) EXPECT_NE(heats[i].text, cools[i].text) << product.id;
    }
}

/// A setting that a template leaves out is set elsewhere, for the reason given.
TEST(Snippets, NameEverySettingThatTheyCanSet) {
    const std::set<std::pair<std::string, std::string>> elsewhere{
        {"ros_control_toolbox", "error_dot"},  // an argument of the call
        {"openplc_iec_pid", "CYCLE_s"},        // by its period in milliseconds
        {"simulink_pid_parallel", "block"},    // the block that is in the model
    };
    for (const Product& product : catalogue())
        for (const Snippet& snippet : product.snippets)
            for (const Setting& setting : product.example.settings) {
                if (elsewhere.contains({std::string(product.id), setting.name})) continue;
                const auto names = names_in(snippet.text);
                EXPECT_NE(std::ranges::find(names, setting.name), names.end()) << product.id << " " << setting.name;
            }
}

TEST(Snippets, SayTheDirection) {
    const auto pasted = [](std::string_view id, double Kp) {
        const Product& product = product_of(id);
        return filled_snippets(product, settings_for(product, {.Kp = Kp}), kContext).front().text;
    };
    EXPECT_THAT(pasted("arduino_pid_v1", 1.5), HasSubstr(", P_ON_E, DIRECT);"));
    EXPECT_THAT(pasted("arduino_pid_v1", -1.5), HasSubstr(", P_ON_E, REVERSE);"));
    EXPECT_THAT(pasted("quickpid", 1.5), HasSubstr("QuickPID::Action::direct);"));
    EXPECT_THAT(pasted("quickpid", -1.5), HasSubstr("QuickPID::Action::reverse);"));
    EXPECT_THAT(pasted("rockwell_pide_independent", -1.5), HasSubstr("Loop.ControlAction := 1;"));
    EXPECT_THAT(pasted("rockwell_pide_independent", 1.5), HasSubstr("Loop.ControlAction := 0;"));
}

TEST(Snippets, PlaceholdersFollowTheirRules) {
    const Settings settings{{"fKp", 1.5}, {"bDInTheFeedbackPath", true}};
    EXPECT_EQ(filled("Kp = {fKp}", settings), "Kp = 1.50");
    EXPECT_EQ(filled("{fKp|2} {tTn_ms|none}", settings), "1.50 none");
    EXPECT_EQ(filled("{bDInTheFeedbackPath=true:TRUE/FALSE} {bPInTheFeedbackPath=true:TRUE/FALSE}", settings),
              "TRUE FALSE");
    EXPECT_EQ(filled("{{a: {{{fKp}}}", settings), "{a: {1.50}}") << "a doubled brace opens one";
    EXPECT_EQ(filled("a\n{tTn_ms}\nb {fKp}", settings), "a\nb 1.50") << "the line without its setting is left out";
    EXPECT_EQ(filled("{tTn_ms}", settings), "") << "a snippet without lines is left out";
    EXPECT_EQ(filled("{sample_time_s} s, {sample_time_ms} ms, {sample_time_us} us", settings),
              "0.25 s, 250 ms, 250000 us");
    EXPECT_THAT(lines_of(filled("a\n\nb", settings)), ElementsAre("a", "", "b"));
}

}  // namespace
}  // namespace tunewright::product
