// OptionSet: conversions between a struct of options, its description and the options of a request.
#include "engine/tuning/method/option_set.h"

#include <gtest/gtest.h>

#include "engine/tuning/method/rule.h"

namespace tunewright {
namespace {

enum class Colour { red, green };

struct Inner {
    double ratio = 0.1;
    std::optional<double> fixed = {};
};

struct Outer {
    double size = 2;
    std::optional<double> target = {};
    int order = 1;
    bool wide = false;
    Colour colour = Colour::green;
    std::optional<double> limit = 1.6;  // empty: "free"
    std::optional<Inner> inner = {};
    std::vector<Inner> parts = {};
};

OptionSet<Inner> inner_set() {
    OptionSet<Inner> set;
    set.field(&Inner::ratio, "ratio", "Ratio.").field(&Inner::fixed, "fixed", "Fixed.");
    return set;
}

OptionSet<Outer> outer_set() {
    OptionSet<Outer> set;
    set.field(&Outer::size, "size", "Size.", {.unit = "time", .exclusive_minimum = 0})
        .field(&Outer::target, "target", "Target.")
        .field(&Outer::order, "order", "Order.")
        .field(&Outer::wide, "wide", "Wide.")
        .choice(&Outer::colour, "colour", "Colour.", Words<Colour>{{"red", Colour::red}, {"green", Colour::green}})
        .number_or_word(&Outer::limit, "limit", "Limit.", "free")
        .object(&Outer::inner, "inner", "Inner.", inner_set(), 1)
        .list(&Outer::parts, "parts", "Parts.", described_option(OptionType::object, "part", "A part."), 3,
              inner_set());
    return set;
}

TEST(OptionSet, DescribesEachDefaultAsTheStructHasIt) {
    const auto set = outer_set();
    const auto& options = set.descriptions();
    EXPECT_EQ(named(options, "size")->default_value, OptionValue(2.0));
    EXPECT_EQ(named(options, "size")->unit, "time");
    EXPECT_EQ(named(options, "order")->type, OptionType::integer);
    EXPECT_EQ(named(options, "colour")->default_value, OptionValue(std::string("green")));
    EXPECT_EQ(named(options, "limit")->default_value, OptionValue(1.6));
    EXPECT_FALSE(named(options, "target")->default_value);
    EXPECT_EQ(named(named(options, "inner")->fields, "ratio")->default_value, OptionValue(0.1));
    EXPECT_EQ(named(options, "unknown"), nullptr);
}

TEST(OptionSet, ReadsWhatIsGivenAndKeepsTheRest) {
    MethodOptions given;
    given.set("order", 2.0);
    given.set("colour", std::string("red"));
    given.set("limit", std::string("free"));
    given.set("inner/fixed", 3.0);
    given.set("parts/0/ratio", 0.5);
    given.set("parts/1/fixed", 7.0);
    const Outer outer = outer_set().read(given);
    EXPECT_EQ(outer.size, 2);
    EXPECT_EQ(outer.order, 2);
    EXPECT_EQ(outer.colour, Colour::red);
    EXPECT_FALSE(outer.limit);
    ASSERT_TRUE(outer.inner);
    EXPECT_EQ(outer.inner->ratio, 0.1);
    EXPECT_EQ(outer.inner->fixed, 3.0);
    ASSERT_EQ(outer.parts.size(), 2u);
    EXPECT_EQ(outer.parts[0].ratio, 0.5);
    EXPECT_EQ(outer.parts[1].fixed, 7.0);
    EXPECT_FALSE(outer_set().read({}).inner);
}

TEST(OptionSet, GivesBackWhatDiffers) {
    const auto set = outer_set();
    EXPECT_TRUE(set.given_for({}).values().empty());
    Outer outer;
    outer.size = 5;
    outer.wide = true;
    outer.limit = {};
    outer.inner = Inner{.ratio = 0.3, .fixed = 4};
    const MethodOptions given = set.given_for(outer);
    EXPECT_EQ(given.values().size(), 5u);
    EXPECT_EQ(given.number("inner/fixed"), 4.0);
    EXPECT_EQ(given.text("limit"), "free");
    const Outer again = set.read(given);
    EXPECT_EQ(again.size, 5);
    EXPECT_EQ(again.inner->ratio, 0.3);
    // A value that equals the default is stated if it differs from the compared one.
    Outer without;
    without.limit = {};
    EXPECT_EQ(set.given_for({}, without).number("limit"), 1.6);
}

struct Shared {
    double ratio = 0.1;
    Colour colour = Colour::red;
};

struct Whole {
    int first = 1;
    Shared shared = {};
    std::optional<NumberRange> span = {};
    std::map<std::string, double> start = {};
    double asked = 3;               // required: its value here is no default
    std::optional<double> Tf = {};  // empty: 0.5
    std::optional<std::variant<double, NumberRange>> either = {};
};

OptionSet<Whole> whole_set() {
    OptionSet<Shared> shared;
    shared.field(&Shared::ratio, "ratio", "Ratio.")
        .choice(&Shared::colour, "colour", "Colour.", Words<Colour>{{"red", Colour::red}, {"green", Colour::green}});
    OptionSet<Whole> set;
    set.field(&Whole::first, "first", "First.")
        .embed(&Whole::shared, shared)
        .field(&Whole::span, "span", "Span.", {.unit = "time", .minimum = 0})
        .field(&Whole::start, "start", "Start.")
        .field(&Whole::asked, "asked", "Asked.", {.required = true})
        .field(&Whole::Tf, "Tf", "Filter.", {.fallback = 0.5})
        .field(&Whole::either, "either", "Either.");
    return set;
}

TEST(OptionSet, DescribesInTheOrderOfTheCalls) {
    const auto set = whole_set();
    std::vector<std::string> names;
    for (const OptionDescription& option : set.descriptions()) names.push_back(option.name);
    EXPECT_EQ(names, (std::vector<std::string>{"first", "ratio", "colour", "span", "start", "asked", "Tf", "either"}));
    const auto& options = set.descriptions();
    EXPECT_TRUE(named(options, "asked")->required);
    EXPECT_FALSE(named(options, "asked")->default_value);
    EXPECT_EQ(named(options, "Tf")->default_value, OptionValue(0.5));
    EXPECT_EQ(named(options, "colour")->choices, (std::vector<std::string>{"red", "green"}));
    EXPECT_EQ(named(options, "span")->unit, "time");
    EXPECT_EQ(named(options, "span")->minimum, 0);
}

TEST(OptionSet, ReadsSharedOptionsRangesAndNumbersByName) {
    MethodOptions given;
    given.set("ratio", 0.7);
    given.set("colour", std::string("green"));
    given.set("span/0", 1.0);
    given.set("span/1", 4.0);
    given.set("start/T", 350.0);
    given.set("start/C", 0.2);
    given.set("either/0", 5.0);
    given.set("either/1", 6.0);
    const Whole whole = whole_set().read(given);
    EXPECT_EQ(whole.shared.ratio, 0.7);
    EXPECT_EQ(whole.shared.colour, Colour::green);
    ASSERT_TRUE(whole.span);
    EXPECT_EQ(whole.span->low, 1);
    EXPECT_EQ(whole.span->high, 4);
    EXPECT_EQ(whole.start, (std::map<std::string, double>{{"C", 0.2}, {"T", 350}}));
    EXPECT_EQ(whole.asked, 3);
    EXPECT_FALSE(whole.Tf);
    ASSERT_TRUE(whole.either);
    EXPECT_EQ(std::get<NumberRange>(*whole.either).high, 6);
}

TEST(OptionSet, GivesBackSharedOptionsUnderTheirOwnNames) {
    Whole whole;
    whole.shared = {.ratio = 0.7, .colour = Colour::green};
    const MethodOptions given = whole_set().given_for(whole);
    EXPECT_EQ(given.values().size(), 2u);
    EXPECT_EQ(given.number("ratio"), 0.7);
    EXPECT_EQ(given.text("colour"), "green");
    EXPECT_EQ(whole_set().read(given).shared.ratio, 0.7);
}

/// Options of the same set below another one's name: paths are joined at every depth.
TEST(OptionSet, ReadsBelowAName) {
    struct Outermost {
        Whole whole = {};
    };
    OptionSet<Outermost> set;
    set.object(&Outermost::whole, "whole", "Whole.", whole_set());
    MethodOptions given;
    given.set("whole/ratio", 0.2);
    given.set("whole/start/T", 1.0);
    const Outermost read = set.read(given);
    EXPECT_EQ(read.whole.shared.ratio, 0.2);
    EXPECT_EQ(read.whole.start.at("T"), 1);
    EXPECT_EQ(set.given_for(read).number("whole/ratio"), 0.2);
}

TEST(OptionSet, FillsInDefaultsAroundWhatIsGiven) {
    MethodOptions given;
    given.set("size", 9.0);
    const MethodOptions all = with_defaults(outer_set().descriptions(), given);
    EXPECT_EQ(all.number("size"), 9.0);
    EXPECT_EQ(all.number("limit"), 1.6);
    EXPECT_EQ(all.boolean("wide"), false);
    EXPECT_FALSE(all.has("target"));
}

}  // namespace
}  // namespace tunewright
