// Records made for tests: the trend of a loop in automatic as a German system exports it, and the log of a heater.

/** The same noise in every run. */
function noise(seed) {
  let state = seed;
  return () => (state = (16807 * state) % 2147483647) / 2147483647 - 0.5;
}

const german = (value, digits) => value.toFixed(digits).replace(".", ",");

/** Steps a first-order plant with dead time; `u` takes the deviations of y and returns that of u. */
function simulate({ K, T, L, dt, count }, u) {
  const waiting = Array(Math.round(L / dt)).fill(0);
  let y = 0;
  return [...Array(count).keys()].map((at) => {
    const now = u(at * dt, y);
    waiting.push(now);
    const row = { t: at * dt, y, u: now };
    y += (dt / T) * (K * waiting.shift() - y);
    return row;
  });
}

/** SP, PV and OP of TIC101 in automatic over 33 minutes, with one step of the set point by 5 degrees. */
export function germanTrend() {
  const [Kp, Ti, dt] = [0.8, 150, 2];
  const random = noise(7);
  let sum = 0;
  const setpoint = (t) => (t < 300 ? 0 : 5);
  const rows = simulate({ K: 1.6, T: 180, L: 30, dt, count: 1000 }, (t, y) => {
    const error = setpoint(t) - y;
    sum += ((Kp * dt) / Ti) * error;
    return Kp * error + sum;
  });
  const clock = (t) => {
    const [hours, minutes, seconds] = [8 + Math.floor(t / 3600), Math.floor(t / 60) % 60, t % 60];
    return `02.03.2026 ${[hours, minutes, seconds].map((part) => String(part).padStart(2, "0")).join(":")}`;
  };
  return [
    "Zeit;TIC101.SP [°C];TIC101.PV [°C];TIC101.OP [%]",
    ...rows.map(({ t, y, u }) =>
      [clock(t), german(60 + setpoint(t), 1), german(60 + y + 0.1 * random(), 2), german(40 + u, 2)].join(";"),
    ),
  ].join("\n");
}

/** A loop under a PI of a program, with moves of the set point and a load, in rows of its own sample time and with all
    digits. */
export function loopUnderPI({ Kp, Ti } = { Kp: 0.8, Ti: 60 }) {
  const dt = 1;
  const random = noise(5);
  let sum = 0;
  const moves = [0, 4, -2, 3, 0, 5];
  const setpoint = (t) => moves[Math.floor(t / 100)];
  const rows = [];
  simulate({ K: 1.6, T: 60, L: 8, dt, count: 600 }, (t, y) => {
    const measured = y + 0.1 * random();
    const error = setpoint(t) - measured;
    sum += ((Kp * dt) / Ti) * error;
    const u = Kp * error + sum;
    rows.push([t, 50 + setpoint(t), (50 + measured).toFixed(6), (40 + u).toFixed(6)].join(","));
    return u + (t > 450 ? 1 : 0);
  });
  return ["Time [s],FIC7.SP [degC],FIC7.PV [degC],FIC7.OP [%]", ...rows].join("\n");
}

/** The temperature of a printer's hot end, and the share of full power, which steps from 0.2 to 0.5. */
export function heaterLog() {
  const random = noise(11);
  const rows = simulate({ K: 260, T: 60, L: 4, dt: 0.5, count: 1000 }, (t) => (t < 60 ? 0 : 0.3));
  return [
    "time_s,temperature_degC,power",
    ...rows.map(({ t, y, u }) => [t.toFixed(1), (77 + y + 0.2 * random()).toFixed(2), (0.2 + u).toFixed(2)].join(",")),
  ].join("\n");
}
