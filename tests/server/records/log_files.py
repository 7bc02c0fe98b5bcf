"""Files in the formats of loggers, printers, historians and home automation, each of a test on a known plant.

A test is simulated once and then written in a format, which hides the same data as a real file (rows between moves,
rounding). Everything comes from seeds."""

import datetime
import json
import math
import random

PARTS = 20  # steps of the simulation per row


class Plant:
    """K e^(-Ls)/((T1 s + 1)(T2 s + 1)), from rest at u0 and y0."""

    def __init__(self, K, T1, L, T2=0.0):
        self.K, self.T1, self.L, self.T2 = K, T1, L, T2

    def run(self, u, row, y0=20.0):
        """y at each row for an input that is constant between rows."""
        h = row / PARTS
        a1 = math.exp(-h / self.T1)
        a2 = math.exp(-h / self.T2) if self.T2 > 0 else 0.0
        fine = [value for value in u for _ in range(PARTS)]
        delay = int(round(self.L / h))
        x1 = x2 = 0.0
        y = []
        for k in range(len(fine)):
            if k % PARTS == 0:
                y.append(y0 + x2)
            held = (fine[k - delay] if k >= delay else u[0]) - u[0]
            x1 = a1 * x1 + (1 - a1) * self.K * held
            x2 = a2 * x2 + (1 - a2) * x1
        return y


class Test:
    """Rows of t, u and y."""

    def __init__(self, plant, levels, row, noise=0.05, y0=20.0, seed=1, digits=2):
        draw = random.Random(seed)
        self.plant, self.row = plant, row
        self.u = [level for level, rows in levels for _ in range(rows)]
        self.t = [k * row for k in range(len(self.u))]
        self.y = [round(value + draw.gauss(0, noise), digits) for value in plant.run(self.u, row, y0)]

    def rows(self):
        return zip(self.t, self.u, self.y)


def stamp(seconds, form="%Y-%m-%dT%H:%M:%S", start=datetime.datetime(2024, 3, 9, 22, 55)):
    return (start + datetime.timedelta(seconds=seconds)).strftime(form)


def csv(test, heading="time,output,temp", form="%g,%g,%.2f"):
    return heading + "\n" + "".join(form % row + "\n" for row in test.rows())


def klipper(test, dump=0, dump_first=False, heater="extruder"):
    """Reports every second, and lines of the microcontroller's traffic."""
    reports = ["Stats %.1f: gcodein=0 mcu: mcu_awake=0.002 freq=71999000 sysload=0.10 %s: target=0 temp=%.1f pwm=%.3f"
               % (31.4 + t, heater, y, u) for t, u, y in test.rows()]
    traffic = ["Receive: %d %.6f %.6f 12: seq: 1%x, analog_in_state oid=7 next_clock=%d value=%d"
               % (k, 186 + 0.03 * k, 185.9995 + 0.03 * k, k % 16, 190000000 + 2160000 * k, 15000 - k % 37)
               for k in range(dump)]
    return "\n".join(traffic + reports if dump_first else reports + traffic) + "\n"


def countdown(test, settling=9, first=0.0):
    """Seconds of settling that count down to the test, which counts up."""
    u0, y0 = test.u[0], test.y[0]
    lines = ["Configuring ... starting"]
    for k in range(settling, -1, -1):
        lines.append(" sec: %.4f  out: %.2f  pv: %.3f  settling" % (k * test.row, u0, first if k == settling else y0))
    moved = next(k for k, u in enumerate(test.u) if u != u0)
    for k in range(moved, len(test.u)):
        lines.append(" sec: %.4f  out: %.2f  pv: %.3f  tan: 0.100" % ((k - moved + 1) * test.row, test.u[k], test.y[k]))
    return "\n".join(lines + [" Output Step: %g" % test.u[-1], "  Kp: 2.13"]) + "\n"


def restarts(tests, heading="time,pwm,temp"):
    """Several runs in one file, each with its heading: a board that was restarted."""
    return "".join(csv(test, heading) for test in tests)


def heater_test(test):
    """Lines of the duty when it changes, then times and temperatures, as with WRITE_FILE=1."""
    changes = [(test.t[k], test.u[k]) for k in range(len(test.u)) if k == 0 or test.u[k] != test.u[k - 1]]
    return ("".join("pwm: %.3f %.3f\n" % (1034.2 + t, u) for t, u in changes)
            + "".join("%.3f %.3f\n" % (1034.2 + t, y) for t, _, y in test.rows()))


def home_assistant(test, others=0, seed=3):
    """One line for each entity when its state changes."""
    draw = random.Random(seed)
    lines, last = ["entity_id,state,last_changed"], {}
    for t, u, y in test.rows():
        states = {"sensor.boiler_temperature": "%.2f" % y, "number.boiler_power": "%g" % u}
        if others and draw.random() < 0.2:
            states["sensor.boiler_linkquality"] = str(draw.randint(60, 120))
            states["binary_sensor.door"] = draw.choice(["on", "off"])
        for entity, state in states.items():
            if last.get(entity) == state:
                continue
            last[entity] = state
            lines.append("%s,%s,%s.000Z" % (entity, state, stamp(t)))
    return "\n".join(lines) + "\n"


def historian(test, tag="TIC7"):
    """Date, time, milliseconds, tag, value, status: one tag after the other."""
    lines = ['"Date","Time","Millitm","TagName","Value","Status"']
    for name, values in ((tag + ".PV", test.y), (tag + ".OUT", test.u)):
        for t, value in zip(test.t, values):
            lines.append('"%s","%s","%d","%s","%g","Good"'
                         % (stamp(t, "%m/%d/%Y"), stamp(t, "%H:%M:%S"), round(t % 1 * 1000), name, value))
    return "\n".join(lines) + "\n"


def influx(test):
    head = "#group,false,false,true,true,false,false,true,true\n#default,mean,,,,,,,\n"
    heading = ",result,table,_start,_stop,_time,_value,_field,_measurement"
    out = head
    for table, (field, values) in enumerate((("temperature", test.y), ("heater_power", test.u))):
        out += heading + "\n"
        for t, value in zip(test.t, values):
            out += ",,%d,2024-03-09T00:00:00Z,2024-03-11T00:00:00Z,%sZ,%g,%s,kiln\n" % (table, stamp(t), value, field)
        out += "\n"
    return out


def wincc(test):
    lines = ['"VarName";"TimeString";"VarValue";"Validity";"Time_ms"']
    for k, (t, u, y) in enumerate(test.rows()):
        for name, value in (("Temp_PV", y), ("Valve_OUT", u)):
            lines.append('"%s";"%s";%s;1;%s' % (name, stamp(t, "%d.%m.%Y %H:%M:%S"), ("%.2f" % value).replace(".", ","),
                                                ("%.6f" % (45360954861.1 + k)).replace(".", ",")))
    return "\n".join(lines) + "\n"


def mqtt(test):
    lines = ["ts,topic,payload"]
    for t, u, y in test.rows():
        lines.append("%.3f,home/kiln/temperature,%.2f" % (1710028500 + t + 0.2, y))
        lines.append("%.3f,home/kiln/heater,%g" % (1710028500 + t, u))
    return "\n".join(lines) + "\n"


def json_array(test, nested=False):
    rows = [{"ts": 1710028500000 + round(1000 * t), "temperature": y, "power": u} for t, u, y in test.rows()]
    if nested:
        rows = [{"ts": row["ts"], "kiln": {"temperature": row["temperature"], "power": row["power"]}} for row in rows]
    return json.dumps(rows)


def json_columns(test):
    return json.dumps({"time": test.t, "heater": test.u, "temperature": test.y})


def json_lines(test):
    return "".join(json.dumps({"time": t, "heater": u, "temperature": y}) + "\n" for t, u, y in test.rows())


def ardupilot(test):
    lines = ["FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns",
             "FMT, 129, 31, PARM, QNff, TimeUS,Name,Value,Default",
             "FMT, 190, 40, RATE, Qffff, TimeUS,RDes,R,ROut,A",
             "FMT, 191, 40, PIDR, Qffffff, TimeUS,Tar,Act,Err,P,I,D",
             "PARM, 1000, ATC_RAT_RLL_P, 0.135, 0.135"]
    for t, u, y in test.rows():
        us = 20000000 + round(1e6 * t)
        lines.append("RATE, %d, 0, %.4f, %.5f, 0.3" % (us, y, u))
        lines.append("PIDR, %d, 0, %.4f, 0, %.4f, 0, 0" % (us + 10, y, u))
    return "\n".join(lines) + "\n"


def trend_export(test):
    """Quoted keys and values, then rows that are marked as data."""
    lines = ['"Trend Name:","TIC_2"', '"Sample Period:","%g Sec"' % test.row, "",
             '"Header:","Date;Time;Millitm","TIC2.PV","TIC2.CVEU","TIC2.SP"']
    for t, u, y in test.rows():
        lines.append('"Data","%s;%d","%.3f","%.2f","40.0"' % (stamp(t, "%m/%d/%Y;%H:%M:%S"), round(t % 1 * 1000), y, u))
    return "\n".join(lines) + "\n"


def switched(test, heading="TimeElapsed,Humidity,Temperature,Target,Heater", bad=None):
    """ON and OFF, with one damaged cell."""
    lines = [heading]
    for k, (t, u, y) in enumerate(test.rows()):
        clock = "%02d:%02d:%02d" % (t // 3600, t // 60 % 60, t % 60)
        lines.append("%s,7.1,%.1f,40.0,%s" % (clock, y, "40.0degC" if k == bad else "ON" if u > 0 else "OFF"))
    return "\n".join(lines) + "\n"


def zigbee(test, seed=5):
    draw = random.Random(seed)
    lines = ["time,linkquality,battery,temperature,humidity,state"]
    for t, u, y in test.rows():
        lines.append("%s+00:00,%d,%d,%.2f,%.1f,%s" % (stamp(t), draw.randint(60, 120), 97 - int(t // 700), y,
                                                      45 + draw.gauss(0, 1), "ON" if u > 0 else "OFF"))
    return "\n".join(lines) + "\n"


def with_false_readings(test, first=None, single=(), run=None, value=-127.0):
    """y with sensor errors: the first rows, single ones, and a run [from, to)."""
    y = list(test.y)
    for k in range(first[1] if first else 0):
        y[k] = first[0]
    for k in single:
        y[k] = value
    if run:
        y[run[0]:run[1]] = [value] * (run[1] - run[0])
    test.y = y
    return test


def joined(lines):
    return "\n".join(lines) + "\n"


def public_logs(test):
    """One file each of many kinds, by name; u is in the test's units, multiplied by ten if the name contains x10."""
    rows = list(test.rows())
    return {
        "thermostat app (x10)": joined(
            ["#Thermostat,Living", "Date,Time,System Mode,Heat Set Temp (F),Current Temp (F),Current Humidity (%RH),"
             "Outdoor Temp (F),Heat Stage 1 (sec),Fan (sec)"]
            + ["%s,%s,heat,70,%.2f,45,30.2,%d,0" % (stamp(t, "%Y-%m-%d"), stamp(t, "%H:%M:%S"), y, 10 * u)
               for t, u, y in rows]),
        "thermostat with a comma": joined(
            ["timestamp;inside_temp;humidity;heating_power_percent;setpoint"]
            + [("%s;%.2f;45.1;%g;21" % (stamp(t), y, u)).replace(".", ",") for t, u, y in rows]),
        "printer's terminal": joined(
            [line for t, u, y in rows for line in (
                "%s,000 - Send: M105" % stamp(t, "%Y-%m-%d %H:%M:%S"),
                "%s,005 - Recv: ok T:%.2f /0.00 B:22.10 /0.00 @:%d B@:0" % (stamp(t, "%Y-%m-%d %H:%M:%S"), y, u))]),
        "historian": joined(
            ['"Timestamp","FIC101.PV","FIC101.OP"']
            + ['"%s",%s,%g' % (stamp(t, "%d-%b-%y %H:%M:%S"), "I/O Timeout" if k in (40, 41) else "%.2f" % y, u)
               for k, (t, u, y) in enumerate(rows)]),
        "historian with descriptions": joined(
            ["Tag,FC1.OP,TI2.PV", "Description,Steam valve,Reactor temp", "Units,%,degC"]
            + ["%s,%g,%.2f" % (stamp(t, "%d/%m/%Y %H:%M:%S"), u, y) for t, u, y in rows]),
        "control system": joined(
            ["Date/Time;PID1/OUT.CV;PID1/PV.CV"]
            + ["%s;%s;%s" % (stamp(t, "%d.%m.%Y %H:%M:%S"), str(u).replace(".", ","), str(y).replace(".", ","))
               for t, u, y in rows]),
        "qualities next to values": joined(
            ["DateTime,TIC.PV,TIC.PV.Quality,TIC.OP,TIC.OP.Quality"]
            + ["%s.000,%.2f,192,%g,192" % (stamp(t, "%Y-%m-%d %H:%M:%S"), y, u) for t, u, y in rows]),
        "espresso machine": json.dumps({"id": 12, "datapoints": {
            "timeInShot": [t for t, _, _ in rows], "temperature": [y for _, _, y in rows],
            "heaterPower": [u for _, u, _ in rows]}}),
        "serial monitor": joined(["%s.000 -> Temp: %.2f C, Heater: %g %%" % (stamp(t, "%H:%M:%S"), y, u)
                                  for t, u, y in rows]),
        "line protocol": joined(["kiln,host=a temp=%.2f,duty=%g %d" % (y, u, (1710028500 + t) * 10 ** 9)
                                 for t, u, y in rows]),
        "dashboard, long": joined(
            ['"Series";"Time";"Value"'] + ['"%s";"%s";%s' % (name, stamp(row[0]), row[at])
                                           for name, at in (("kiln.temp", 2), ("kiln.duty", 1)) for row in rows]),
        "building bus": joined(
            ["Timestamp;GroupAddress;Name;Value"]
            + [line for t, u, y in rows for line in ("%s;1/2/3;Room temp;%.2f" % (stamp(t), y),
                                                     "%s;1/2/4;Valve;%g" % (stamp(t), u))]),
        "node ids": joined(
            ["SourceTimestamp,NodeId,Value,StatusCode"]
            + [line for t, u, y in rows for line in ("%sZ,ns=2;s=Tank.Level,%.2f,Good" % (stamp(t), y),
                                                     "%sZ,ns=2;s=Tank.Valve,%g,Good" % (stamp(t), u))]),
        "tags without headings": joined(["%s,%s,%s" % (stamp(t), name, value) for t, u, y in rows
                                         for name, value in (("TIC1.PV", y), ("TIC1.OP", u))]),
        "history as lists": json.dumps(
            [[{"entity_id": "sensor.boiler_temperature", "state": str(y), "last_changed": stamp(t) + "+00:00"}
              for t, _, y in rows],
             [{"entity_id": "number.boiler_power", "state": str(u), "last_changed": stamp(t) + "+00:00"}
              for k, (t, u, _) in enumerate(rows) if k == 0 or u != rows[k - 1][1]]]),
        "started twice": joined(
            ["Booting...", "time_ms,pwm,temp"] + ["%d,10,20" % (1000 * t) for t in range(0, 40, 5)]
            + ["Booting...", "time_ms,pwm,temp"] + ["%d,%d,%.2f" % (1000 * t, u, y) for t, u, y in rows]),
    }
