"""An example for every body that a request can have, by the name of its operation."""

from typing import Any

COMMANDS: dict[str, dict[str, Any]] = {
    "begin_service_mode": {"name": "A. Kaya"},
    "confirm_area_clear": {},
    "end_service_mode": {},
    "home": {},
    "move": {"azimuth_deg": 180, "elevation_deg": 40},
    "park": {},
    "release_inhibit": {},
    "reset_fault": {},
    "resume": {},
    "set_home": {"axes": ["azimuth", "elevation"], "confirmed": True},
    "set_inhibit": {"name": "A. Kaya", "reason": "Gearbox is being changed."},
    "set_mode": {"mode": "dual"},
    "step": {"axis": "azimuth", "delta_deg": 0.5},
    "stow": {"position": "hail"},
    "test_communication_loss": {"axis": "azimuth"},
    "test_direction": {"axis": "azimuth"},
    "test_scale": {"axis": "azimuth", "delta_deg": 30},
    "test_stop": {"axis": "azimuth", "speed": "jog"},
    "track": {},
    "undo_home": {},
}
"""What each command takes beside its type."""

BODIES: dict[str, Any] = {
    "add_tracker": {"tracker_id": "T2", "name": "South field", "drive": {"kind": "simulated"}},
    "add_user": {"name": "kaya", "roles": ["operator"], "password": "four plain words here"},
    "answer_direction_test": {"right": True},
    "answer_scale_test": {"measured_deg": 30.2},
    "apply_sightings": {"keep": [1, 2, 3]},
    "change_control": {"action": "request", "reason": "Service at the tracker."},
    "change_network": {"host": "127.0.0.1", "port": 8443, "tls": True},
    "change_password": {"old": "four plain words here", "new": "four other words here"},
    "change_tracker": {"deadband_deg": 0.5, "azimuth": {"minimum_deg": -10, "maximum_deg": 370}},
    "change_user": {"roles": ["operator", "engineer"]},
    "check_drive": {"kind": "modbus-tcp", "profile": "simulated-plc", "host": "127.0.0.1", "port": 502},
    "confirm_network": {"ticket": "mB1x0Q"},
    "confirm_password": {"password": "four plain words here"},
    "create_token": {"name": "SCADA", "scopes": ["read", "motion"], "days": 90, "trackers": ["T1"]},
    "find_best_programs": {"date": "2026-06-21", "latitude_deg": 41.29, "longitude_deg": 36.33},
    "inject_fault": {"fault": "stall"},
    "jog_axis": {"press_id": "p-1", "axis": "azimuth", "direction": 1, "speed": "slow"},
    "plan_show": {
        "start": "2026-06-21T06:00:00+03:00",
        "end": "2026-06-21T20:00:00+03:00",
        "duration_s": 180,
    },
    "plan_strategy_day": {"date": "2026-06-21"},
    "rename_site": {"name": "Samsun"},
    "report_weather": {
        "wind_mps": 4.2,
        "wind_direction_deg": 210,
        "irradiance_wm2": 820,
        "temperature_degc": 24.5,
    },
    "request_control_of_group": {"tracker_ids": ["T1", "T2"], "reason": "Cleaning."},
    "rerun_recording": {"tracker_id": "T1", "duration_s": 120},
    "review_change": {"azimuth": {"maximum_deg": 380}},
    "set_clock": {"source": "manual", "at": "2026-06-21T12:00:00+03:00", "time_zone": "Europe/Istanbul"},
    "set_horizon": {
        "points": [{"azimuth_deg": 90, "elevation_deg": 4}, {"azimuth_deg": 135, "elevation_deg": 8}]
    },
    "set_location": {
        "latitude_deg": 41.2867,
        "longitude_deg": 36.33,
        "altitude_m": 4,
        "time_zone": "Europe/Istanbul",
    },
    "set_settings_lock": {"locked": False, "reason": "The drive was replaced."},
    "set_soft_limit": {"axis": "azimuth", "end": "upper"},
    "set_station": {"host": "127.0.0.1", "port": 502, "unit": 1},
    "set_windows": {"gust_s": 3, "mean_s": 600, "wind_old_after_s": 60},
    "shelve_alarm": {"minutes": 60, "reason": "The sensor is being replaced."},
    "sign_in": {"name": "kaya", "password": "four plain words here"},
    "sign_record": {
        "signatures": [
            {"role": "technician", "name": "A. Kaya", "strokes": [[[100, 150], [300, 120], [500, 180]]]}
        ],
        "remark": "Cable of the azimuth encoder renewed.",
    },
    "simulate_span": {"tracker_id": "T1", "date": "2026-06-21", "step_s": 10, "title": "Solstice"},
    "simulate_weather": {"scenario": "storm", "seed": 7},
    "start_study": {"date": "2026-06-21", "span": "day", "modes": ["azimuth", "dual"]},
    "upload_photo": {"photo": "plate.jpg", "caption": "Type plate"},
    "upload_weather_file": {"file": "Samsun.epw"},
    "write_notifications": {"mail_to": ["night@localhost"], "mail_priorities": [1, 2]},
    "write_program": {
        "name": "Three steps",
        "steps": [
            {"from_h": 6, "first_deg": 90, "second_deg": 20},
            {"from_h": 11, "first_deg": 180, "second_deg": 60},
            {"from_h": 16, "first_deg": 270, "second_deg": 20},
        ],
    },
    "write_program_table": "clock_time,azimuth_deg,elevation_deg\n06:00,90,20\n12:00,180,60\n",
}


def exemplify(document: dict[str, Any]) -> None:
    """Give every body its example, and the commands one for each type."""
    for operations in document["paths"].values():
        for operation in operations.values():
            for content in operation.get("requestBody", {}).get("content", {}).values():
                name = operation["operationId"]
                if name == "send_command":
                    told = {kind: {"value": {"type": kind, **more}} for kind, more in COMMANDS.items()}
                    content["examples"] = told
                else:
                    content["example"] = BODIES[name]
