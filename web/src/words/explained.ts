// What each figure means: two sentences, a picture where one helps, and the document that says more.

export type PictureName = "distance" | "margins" | "area" | "step" | "travel" | "weight" | "load" | "samples";

export interface Explanation {
  title: string;
  text: string;
  picture?: PictureName;
  /** A document and its section, as in documentAddress. */
  more: readonly [id: string, anchor: string];
}

const LOOP = ["symbols", "loop"] as const;
const PERFORMANCE = ["symbols", "performance"] as const;
const CONTROLLER = ["symbols", "controller-c"] as const;
const TERMS = ["glossary", "design-and-evaluation"] as const;
const CHECK = ["symbols", "check"] as const;

/** By the figure's name in the contract. */
export const EXPLANATIONS = {
  Ms: { title: "Ms, the peak of |S|", text: "1/Ms is the shortest distance of the Nyquist curve from −1, the point where the loop would oscillate. A loop with 1.4 is calm, with 2 sharp; the larger Ms, the less the plant may differ from its model.", picture: "distance", more: LOOP },
  Mt: { title: "Mt, the peak of |T|", text: "The largest amplification from the set point to the measurement at any frequency. Above 1.3 the response to the set point usually overshoots, unless the set-point weight b is small.", picture: "distance", more: LOOP },
  Mks: { title: "Mks, the noise gain", text: "The largest amplification from noise on the measurement to the controller output. A longer filter time Tf or less derivative action lowers it, and spares the actuator.", more: LOOP },
  worst_Ms: { title: "Worst Ms", text: "The largest Ms of all plants that the request names or that fit the record. It says how the loop behaves if the plant is not quite its model.", picture: "distance", more: ["uncertain", ""] },
  stable_fraction: { title: "Stable plants", text: "The share of the plants in the set, the ranges or the confidence region with which the loop is stable. Below 100 % the settings should not be used.", more: ["uncertain", ""] },
  gain_margin: { title: "Gain margin", text: "The factor by which the gain of plant or controller may grow before the loop oscillates. On the Nyquist curve: the inverse of the distance from 0 at which it crosses the negative axis.", picture: "margins", more: LOOP },
  gain_margin_low: { title: "Gain margin, low", text: "The fraction to which the loop gain may fall before the loop becomes unstable. Only plants that are unstable by themselves, or with two integrators, have one.", picture: "margins", more: LOOP },
  phase_margin_deg: { title: "Phase margin", text: "The extra phase lag at which the loop would oscillate: the angle between −1 and the Nyquist curve where |L| is 1. 45° to 60° is usual; Ms says more, because the curve may come closer to −1 elsewhere.", picture: "margins", more: LOOP },
  delay_margin: { title: "Delay margin", text: "The extra dead time at which the loop would oscillate, in the loop's unit of time. Half of a sample time of the controller counts as extra dead time.", picture: "margins", more: LOOP },
  omega_Ms: { title: "ω of Ms", text: "The frequency at which the Nyquist curve is closest to −1. A disturbance with this frequency is amplified most, by Ms.", picture: "distance", more: LOOP },
  omega_Mt: { title: "ω of Mt", text: "The frequency at which |T| peaks. If the loop rings after a set-point step, it rings near this frequency.", more: LOOP },
  gain_crossover: { title: "Gain crossover", text: "The frequency at which |L| is 1; below it the loop acts, above it hardly. Its inverse is roughly the time in which the loop reacts.", picture: "margins", more: LOOP },
  phase_crossover: { title: "Phase crossover", text: "The frequency at which the phase of L is −180°. The gain margin is read here.", picture: "margins", more: LOOP },
  IAE: { title: "IAE, integrated absolute error", text: "The area between the measurement and its target after a step: large, long and oscillating errors all count. Half the IAE means half the product out of specification, if the loss grows with the deviation.", picture: "area", more: PERFORMANCE },
  ISE: { title: "ISE, integrated squared error", text: "The area under the squared error after a step. Large errors count more than with the IAE, long small ones less.", picture: "area", more: PERFORMANCE },
  ITAE: { title: "ITAE, integrated time-weighted error", text: "The area under the error times the time since the step. Errors that last count more than those at the beginning, which no controller can avoid.", picture: "area", more: PERFORMANCE },
  excess: { title: "Over the optimum", text: "How far the load IAE lies above that of the robust PID whose limits on Ms and Mt are both this Ms, with the usual filter. A controller with a larger Mt or another filter can lie below it.", picture: "area", more: TERMS },
  peak: { title: "Peak after a load step", text: "The largest deviation of the measurement after a step of the load, with its sign. The part before the dead time has passed is the same with every controller.", picture: "load", more: PERFORMANCE },
  overshoot_percent: { title: "Overshoot", text: "How far the measurement passes a new set point, in percent of the step. A smaller set-point weight b lowers it without making the loop slower against disturbances.", picture: "step", more: PERFORMANCE },
  settling_time: { title: "Settling time", text: "The last time at which the measurement is more than 2 % of the step away from the new set point. A single slow tail lengthens it much.", picture: "step", more: PERFORMANCE },
  recovery_time: { title: "Recovery time", text: "The last time after a load step at which the deviation is more than 2 % of its peak. It is mostly set by the integral time Ti.", picture: "load", more: PERFORMANCE },
  rise_time: { title: "Rise time", text: "The time from 10 % to 90 % of a set-point step. Faster rises need more movement of the actuator and more overshoot.", picture: "step", more: PERFORMANCE },
  TV: { title: "TV, total variation of u", text: "All movements of the controller output after a step, up and down, added. It is a measure of the wear of a valve: twice the TV is twice the travel.", picture: "travel", more: PERFORMANCE },
  first_move: { title: "First move of u", text: "The jump of the controller output right after a set-point step: Kp times b times the step. It is limited by the range of the actuator.", picture: "travel", more: PERFORMANCE },
  Kp: { title: "Kp, proportional gain", text: "The controller output changes by Kp for each unit of error, at once. Some products take its inverse as a proportional band, in percent of ranges.", more: CONTROLLER },
  Ti: { title: "Ti, integral time", text: "With a constant error the integral part repeats the proportional one every Ti. The shorter Ti, the faster an error is removed, and the closer the loop is to oscillation.", more: CONTROLLER },
  Td: { title: "Td, derivative time", text: "The controller acts on where the error would be Td later if it went on as now. It allows a higher gain on slow plants, and amplifies noise unless it is filtered.", more: CONTROLLER },
  Tf: { title: "Tf, filter time constant", text: "Faster changes of the measurement than Tf are smoothed before the controller acts on them. It lowers the noise gain Mks and takes some phase margin, which the design counts.", more: CONTROLLER },
  Tf_over_Td: { title: "Tf/Td, filter against derivative time", text: "The filter time constant Tf as a part of the derivative time Td. A larger part lets less noise reach the controller output, and takes some of what the derivative action gains.", more: CONTROLLER },
  Ki: { title: "Ki, integral gain", text: "A constant error of 1 moves the controller output by Ki in each unit of time. It is Kp/Ti of the ideal form: the larger Ki, the faster an error is removed, and the closer the loop is to oscillation.", more: CONTROLLER },
  Kd: { title: "Kd, derivative gain", text: "A measurement that moves by 1 in each unit of time shifts the controller output by Kd. It is Kp Td of the ideal form; it damps slow plants, and amplifies noise unless it is filtered.", more: CONTROLLER },
  filter: { title: "Filter", text: "Where the filter acts: on the derivative part alone, or on the measurement as a whole. On the measurement it also smooths what the proportional part sees.", more: CONTROLLER },
  b: { title: "b, set-point weight", text: "The part of a set-point change that the proportional action sees at once; the integral takes the rest. With b near 0 set-point changes are smooth, with 1 fast, and disturbances are handled the same.", picture: "weight", more: CONTROLLER },
  c: { title: "c, set-point weight of the derivative", text: "The part of a set-point change that the derivative action sees. It is almost always 0: a step would make the output jump.", picture: "weight", more: CONTROLLER },
  setpoint_filter: { title: "Set-point filter", text: "A lag between the set point that is entered and the one that the controller follows. It makes set-point changes smooth, and disturbances are handled the same.", picture: "weight", more: CONTROLLER },
  closed_loop_time: { title: "Time constant of the closed loop", text: "The time in which the measurement should cover 63 % of a set-point change, after the dead time. The shorter it is against the dead time, the sharper the loop and the less the plant may differ from its model.", picture: "step", more: ["methods", ""] },
  degradation: { title: "Allowed loss of performance", text: "The part of the best performance on the model that is given up for robustness. With 0 the loop is fast and hardly robust, with 0.5 calm.", picture: "distance", more: ["methods", ""] },
  delta_r: { title: "delta_r", text: "Errors much larger than this hardly enter the integral of the nonlinear controller. It avoids the overshoot after large set-point changes.", more: CONTROLLER },
  action: { title: "Direction of action", text: "Reverse: the output falls when the measurement rises, as for heating. Direct: it rises with it, as for cooling or a drain.", more: ["glossary", "loop-and-controller"] },
  longest_sample_time: { title: "Longest sample time", text: "The longest time between two computations of the controller with which the loop keeps its robustness, because half of it acts as dead time. A program that is called less often needs settings that were designed for that.", picture: "samples", more: ["numerics", "controllers-that-sample"] },
  cause: { title: "Cause", text: "Why the loop is as it is, by tests of its record. A full disc is sure, a half one likely; a ring means that the record does not show the cause.", more: ["check", "the-verdicts-and-what-each-rests-on"] },
  error_change: { title: "Error now/before", text: "The standard deviation of the error, over that of the earlier check. Below 1 the loop follows its set point more closely than it did.", more: ["check", "watch-a-plant"] },
  significant: { title: "Significant", text: "Yes: chance does not explain so large a change of the error (F test of the two variances, with the independent values of each record). No: two records of the same loop may differ by as much.", more: ["check", "watch-a-plant"] },
  mending_gain: { title: "Gain", text: "How much smaller the mean magnitude of the error may become if the cause is removed, also in percent of that error. It is an estimate: half of the error of a loop that is tuned too slow, most of an oscillation that the loop makes itself.", more: ["check", "many-loops-together"] },
  mending_money: { title: "Money per hour", text: "The gain of the mean error times the weight of the loop. The weight is what a mean error of one unit of the measurement costs in an hour; with weights the list is in order of money.", more: CHECK },
  period: { title: "Period", text: "The time from peak to peak of the strongest regular oscillation of the error. Loops with the same period often have the same source: the map of periods joins them.", more: CHECK },
  regularity: { title: "Regularity", text: "The mean time between zero crossings of the autocorrelation over three of its standard deviations. Above 1 the oscillation is regular; loads that wander stay below.", more: CHECK },
  period_share: { title: "Share", text: "The part of the error's variance that belongs to this oscillation. The rest is noise, drift, or another oscillation.", more: CHECK },
  amplitude: { title: "Amplitude", text: "Half of the distance from the lowest to the highest value of the oscillation, in the unit of the measurement. Noise and drift are filtered out before.", more: CHECK },
  mean_error: { title: "Mean error", text: "The mean magnitude of the set point minus the measurement over the record. Without a set point the mean of the measurement takes its place.", more: CHECK },
  variability: { title: "Standard deviation", text: "The standard deviation of the error over the record. Compare it with what the product or the process tolerates, not with other loops.", more: CHECK },
  harris: { title: "Harris range", text: "The variance that no controller can avoid over the variance of the error, between 0 and 1; near 1 tuning cannot lower the variance. It is a range because the dead time of the loop is not known: the ends belong to the shortest and the longest possible one.", more: CHECK },
  idle_index: { title: "Idle index", text: "How often output and measurement move in the same direction after disturbances, from −1 to 1. Above 0.4 the loop is sluggish; it is reliable only where single disturbances are visible.", more: CHECK },
  following: { title: "Following", text: "The variance of the error over that of the set point. Near 0 the measurement follows the set point closely, near 1 hardly.", more: CHECK },
  travel: { title: "Travel of the output", text: "All movements of the controller output, up and down, added, in ranges of the output per hour. It wears the valve; noise and an oscillation are its usual reasons.", picture: "travel", more: CHECK },
  reversals: { title: "Reversals of the output", text: "How often in an hour the controller output changes its direction. Each reversal costs a valve with friction more than a long move.", more: CHECK },
  in_automatic: { title: "In automatic", text: "The share of the time in which the controller computed its output, cascade included. It needs a column of the mode.", more: CHECK },
  at_limit: { title: "At a limit", text: "The share of the time in which the controller output was at an end of its range. There nothing is controlled, whatever the settings are.", more: CHECK },
  output_still: { title: "Output at rest", text: "The share of the time in long parts in which the output stayed at one value while the measurement moved. This is what a loop in manual looks like without a column of the mode.", more: CHECK },
  measurement_still: { title: "Measurement at rest", text: "The share of the time in long parts in which the measurement stayed at one value while the output moved. A frozen transmitter, a blocked line, or a historian that stores too little.", more: CHECK },
  held: { title: "Repeated measurements", text: "The share of rows whose measurement is that of the row before. A large share means that the historian stores only larger changes, or that the measurement comes in coarse steps.", more: CHECK },
  noise: { title: "Noise of the measurement", text: "The standard deviation of the measurement from row to row, without slower movements. The controller passes it on to the valve.", more: CHECK },
  error_ratio: { title: "Mean error, new over old", text: "The mean magnitude of the error in the recorded time with the new settings, over that of the record. It is computed on the identified plant with the set points and disturbances of the record: 0.6 means that four tenths of the error would not have been there.", more: CHECK },
  valve_size: { title: "Dead band and stick", text: "How far the controller output moves before the valve follows, in the unit of the output. The oscillation lasts as long as this band is there; settings only change its period.", more: CHECK },
  valve_jump: { title: "Jump when it breaks loose", text: "How far the valve jumps when it overcomes its friction, in the unit of the output. With a jump of 0 the valve has play, but does not stick.", more: CHECK },
} as const satisfies Record<string, Explanation>;

export type ExplainedName = keyof typeof EXPLANATIONS;
