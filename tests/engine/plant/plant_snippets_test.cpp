// Plants as control software writes them: each text is read as the plant that its software makes of it, models that a
// plant cannot be are refused with the cure, and every text that is written is read back.
#include "engine/plant/typed/plant_snippets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <variant>

#include "engine/plant/typed/typed_plant.h"
#include "tests/engine/plant/random_plants.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text) {
    const auto read = read_plant(text);
    return read ? "no fault; read as " + plant_text(read->plant) : read.error().message;
}

/// The largest relative difference of the frequency responses; infinite if the text is refused.
double difference(const std::string& text, const Plant& plant) {
    const auto read = read_plant(text);
    EXPECT_TRUE(read) << text << "\n" << (read ? "" : read.error().message);
    return read ? distance(plant, read->plant) : INFINITY;
}

constexpr double kRounding = 1e-13;

TEST(PlantSnippets, OnePlantInEverySoftwareIsThatPlant) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    for (const char* text : {
             "tf([2],[10 1],'InputDelay',3)",
             "tf(2,[10 1],'OutputDelay',3)",
             "tf(2, [10, 1], 'IODelay', 3, 'InputName', 'heater')",
             "tf(2,[10 1],'InputDelay',1,'OutputDelay',2)",
             "G = tf(2,[10 1]); G.InputDelay = 3;",
             "s = tf('s'); G = exp(-3*s)*2/(10*s+1)",
             "s=tf(\"s\")\nG = 2/(10s+1)*exp(-3s)",
             "s = zpk('s'); P = 0.2*exp(-3*s)/(s + 0.1);",
             "K = 2; T = 10; L = 3; s = tf('s'); G = K*exp(-L*s)/(T*s + 1)",
             "num = [2]; den = [10 1]; % first order\nG = tf(num, den, 'InputDelay', 3);",
             "den = conv([5 0.5], 2); G = tf(2, den, 'IODelay', 3)",
             "zpk([],-0.1,0.2,'InputDelay',3)",
             "ss(-0.1,1,0.2,0,'InputDelay',3)",
         })
        EXPECT_LT(difference(text, plant), kRounding) << text;
    for (const char* text :
         {"delay(3)*tf([2],[10,1])", "tf(2,[10,1])*delay(3)",
          "using ControlSystems\n\nP = tf([2.0], [10.0, 1.0]) * delay(3)", "zpk(Float64[], [-0.1], 0.2)*delay(3)",
          "s = tf(\"s\")\nP = 2/(10s + 1) * delay(3)", "FirstOrder(k=2,T=10)*FixedDelay(delayTime=3)",
          "Modelica.Blocks.Continuous.TransferFunction p(b={2}, a={10, 1});\nModelica.Blocks.Nonlinear.FixedDelay "
          "d(delayTime=3);\nequation\n  connect(p.y, d.u);",
          "control.tf([2],[10,1])*exp(-3*s)", "ct.TransferFunction([2], [10, 1], dt=0)*exp(-3*s)",
          "import control as ct\ns = ct.TransferFunction.s\nnum = [2]\nden = [10, 1]  # seconds\nP = ct.tf(num, "
          "den)*exp(-3*s)",
          "import numpy as np\nden = np.convolve([10, 1], [1])\nP = tf(np.array([2]), den)*delay(3)"})
        EXPECT_LT(difference(text, plant), kRounding) << text;
}

TEST(PlantSnippets, OtherPlantsOfEverySoftware) {
    EXPECT_LT(difference("SecondOrder(k=3, w=2, D=0.2)", OscillatorySopdt{.K = 3, .T = 0.5, .zeta = 0.2}), kRounding);
    EXPECT_LT(difference("Modelica.Blocks.Continuous.Integrator(k=0.5)", Ipdt{.K = 0.5}), kRounding);
    EXPECT_LT(difference("FixedDelay(delayTime=3)", Fopdt{.K = 1, .L = 3}), kRounding);
    const Zpk roots{.K = 5, .zeros = {-1}, .poles = {-2, {-3, 4}, {-3, -4}}};
    for (const char* text : {"zpk([-1],[-2 -3+4i -3-4i],5)", "zpk(-1,[-2, -3+4j, -3-4j],5)", "zpk([-1],[-2 -3±4i],5)",
                             "zpk([-1.0], [-2.0, -3+4im, -3-4im], 5)", "ct.zpk([-1], [-2, -3+4j, -3-4j], gain=5)",
                             "z = -1; p = [-2; -3+4*1i; -3-4*1i]; G = zpk(z, p, 5)"})
        EXPECT_LT(difference(text, roots), kRounding) << text;
    const StateSpace states{.A = {{0, 1}, {-2, -3}}, .B = {0, 1}, .C = {1, 0}, .D = 0.5, .L = 2};
    for (const char* text :
         {"ss([0 1; -2 -3],[0; 1],[1 0],0.5,'InputDelay',2)", "exp(-2*s)*ss([0,1;-2,-3],[0;1],[1,0],[0.5])",
          "ct.ss([[0, 1], [-2, -3]], [[0], [1]], [[1, 0]], [[0.5]])*exp(-2*s)",
          "delay(2)*ss([0 1; -2 -3],[0, 1],[1 0],0.5)",
          "A = [0 1\n-2 -3]; B = [0 1]'; C = [1 0]; D = 0.5; G = ss(A,B,C,D); G.OutputDelay = 2;",
          "2*exp(-2*s)*ss([0 1; -2 -3],[0; 1],[0.5 0],0.25)",
          "Modelica.Blocks.Continuous.StateSpace p(A=[0,1;-2,-3], B=[0;1], C=[1,0], D=[0.5]);\nFixedDelay "
          "d(delayTime=2);\nconnect(d.y, p.u);"})
        EXPECT_LT(difference(text, states), kRounding) << text;
    // A sign after a blank and before none begins a new number in MATLAB.
    EXPECT_LT(difference("tf([2*3 1],[10/2 -1 1])", TransferFunction{.num = {6, 1}, .den = {5, -1, 1}}), kRounding);
    EXPECT_LT(difference("tf([6 1],[5 - 1 1])", TransferFunction{.num = {6, 1}, .den = {4, 1}}), kRounding);
}

TEST(PlantSnippets, ModelsThatAPlantCannotBeAreRefusedWithTheCure) {
    for (const char* line :
         {"tf([1],[1 1],0.1)", "tf(1,[1 1],'Ts',0.1)", "ct.tf([1],[1,1],dt=0.1)", "ct.tf([1],[1,1],True)", "tf('z')",
          "z = tf('z',0.1); G = 1/(z-1)", "c2d(tf(1,[1 1]),0.1)", "tf([1],[1,1],0.1)", "ss(1,1,1,0,0.1)"})
        EXPECT_THAT(refusal(line), HasSubstr("discrete time")) << line;
    EXPECT_THAT(refusal("tf(1,[1 1],0.1)"), HasSubstr("position 12: another argument would be a sample time"));
    EXPECT_THAT(refusal("pade(3,2)*tf(1,[1 1])"), HasSubstr("position 1: an approximated dead time is not needed"));
    EXPECT_THAT(refusal("pid(1,2,3)"), HasSubstr("is a controller; give it as baseline"));
    EXPECT_THAT(refusal("tf([1 2;3 4],[1 2])"), HasSubstr("from one input to one output"));
    EXPECT_THAT(refusal("tf(num,[10 1])"), HasSubstr("\"num\" has no value here"));
    EXPECT_THAT(refusal("tf([n 1],[10 1])"), HasSubstr("position 5: \"n\" has no value here"));
    EXPECT_THAT(refusal("tf([],[10 1])"), HasSubstr("this list is empty"));
    EXPECT_THAT(refusal("tf(1,[0 0])"), HasSubstr("position 6: the denominator is 0"));
    EXPECT_THAT(refusal("tf(1,[10 1],'Delay2',3)"), HasSubstr("\"Delay2\" is unknown in tf"));
    EXPECT_THAT(refusal("tf(1,[10 1],'TimeUnit','minutes')"), HasSubstr("units.time"));
    EXPECT_THAT(refusal("FirstOrder(k=2)"), HasSubstr("T is missing in the call of FirstOrder"));
    EXPECT_THAT(refusal("SecondOrder(w=0, D=1)"), HasSubstr("w must not be 0"));
    EXPECT_THAT(refusal("Modelica.Blocks.Math.Feedback f(k=3);"), HasSubstr("\"Feedback\" is not read here"));
    EXPECT_THAT(refusal("FirstOrder a(T=1);\nFirstOrder b(T=2);"), HasSubstr("connect(a.y, b.u)"));
    EXPECT_THAT(refusal("FirstOrder a(T=1);\nFirstOrder b(T=2);\nconnect(a.y, b.u);\nconnect(b.y, a.u);"),
                HasSubstr("in one series"));
    EXPECT_THAT(refusal("FirstOrder a(T=1);\nconnect(a.y, c.u);"), HasSubstr("\"c\" is not a block"));
    EXPECT_THAT(refusal("s = 5; G = 1/(s+1)"), HasSubstr("s is the variable of the plant"));
    EXPECT_THAT(refusal("G = 1/(10*s+1); Ms = 1.4"), HasSubstr("the last statement is a number"));
    EXPECT_THAT(refusal("s = tf('s'); den = [10 1]"), HasSubstr("the last statement is a list"));
    EXPECT_THAT(refusal("1/(s+1); G = 2/(s+1)"), HasSubstr("position 1: this value is not used"));
    EXPECT_THAT(refusal("ss(-1,1,1,0)/(s+1)"), HasSubstr("a state space can only be multiplied"));
    EXPECT_THAT(refusal("ss([1 2],1,1,0)"), HasSubstr("A"));
    EXPECT_THAT(refusal("G = tf(1,[1 1]); G.Ts = 1;"), HasSubstr("only InputDelay, OutputDelay and IODelay"));
    EXPECT_THAT(refusal("tf(1,[1 1],'InputDelay',3"), HasSubstr("a bracket is not closed; it opens at position 3"));
    EXPECT_THAT(refusal("tf(" + std::string(200, '[') + "1"), HasSubstr("30 deep"));
}

TEST(PlantSnippets, EveryWrittenTextIsReadBackAsThePlant) {
    RandomPlants plants;
    double worst = 0;
    int texts = 0;
    for (int i = 0; i < 3000; ++i) {
        const Plant plant = plants.next();
        if (!LinearPlant::make(plant)) continue;
        for (const PlantSnippet& snippet : plant_snippets(plant, i % 2 == 0 ? "s" : "min")) {
            if (snippet.text.size() > 2000) continue;  // a line of a request is no longer
            const bool approximated = snippet.name.starts_with("Python") && dead_time(plant) != 0;
            if (approximated) {
                const std::string line = snippet.text;
                EXPECT_THAT(refusal(line), HasSubstr("an approximated dead time is not needed"));
                continue;
            }
            const double found = difference(snippet.text, plant);
            // Modelica has no block of zeros and poles: the factors of a plant are multiplied, which rounds.
            const bool expanded = snippet.name == "Modelica" && std::holds_alternative<Zpk>(plant);
            EXPECT_LT(found, expanded ? 1e-6 : 1e-9) << snippet.text;
            if (!expanded) worst = std::max(worst, found);
            ++texts;
        }
    }
    EXPECT_GT(texts, 8000);
    RecordProperty("texts", texts);
    std::printf("%d texts read back, the worst difference is %.2g\n", texts, worst);
}

TEST(PlantSnippets, TheUnitOfTimeIsInTheFirstLineIfItIsNotSeconds) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto matlab = [&](const char* unit) { return plant_snippets(plant, unit).front().text; };
    EXPECT_EQ(matlab("s"), "P = tf([2], [10 1], 'InputDelay', 3);");
    EXPECT_EQ(matlab("min"), "% times in min\nP = tf([2], [10 1], 'InputDelay', 3);");
    // A label is free text and must not leave its comment.
    EXPECT_EQ(matlab("min\nP = 1"), "P = tf([2], [10 1], 'InputDelay', 3);");
}

}  // namespace
}  // namespace tunewright
