// OptionSet: a struct of options, its description and what a request gives, each made from the other.
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
    set.number(&Inner::ratio, "ratio", "Ratio.").number(&Inner::fixed, "fixed", "Fixed.");
    return set;
}

OptionSet<Outer> outer_set() {
    OptionSet<Outer> set;
    set.number(&Outer::size, "size", "Size.", {.unit = "time", .exclusive_minimum = 0})
        .number(&Outer::target, "target", "Target.")
        .number(&Outer::order, "order", "Order.")
        .flag(&Outer::wide, "wide", "Wide.")
        .choice(&Outer::colour, "colour", "Colour.", Words<Colour>{{"red", Colour::red}, {"green", Colour::green}})
        .number_or_word(&Outer::limit, "limit", "Limit.", "free")
        .object(&Outer::inner, "inner", "Inner.", inner_set(), 1)
        .object_list(&Outer::parts, "parts", "Parts.", {.name = "part", .sentence = "A part."}, inner_set(), 3);
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
    // A value that equals the default is stated where it differs from what it is compared with.
    Outer without;
    without.limit = {};
    EXPECT_EQ(set.given_for({}, without).number("limit"), 1.6);
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
