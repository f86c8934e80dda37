"""The page in a browser: no complaint, no foreign address, gearfe's own numbers, and what its buttons and keys do."""

import json
import shutil
import socket
import threading

import pytest

pytest.importorskip("starlette")
from browser import Browser

from gearfe.app.fields import START, checked_state
from gearfe.app.server import application, running
from gearfe.app.solving import answer
from gearfe.app.workers import Pool

pytestmark = [pytest.mark.slow, pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium")]
READY = "typeof shown === 'object' && shown?.method.includes('estimated') && !document.body.classList.contains('dim')"


@pytest.fixture(scope="module")
def place():
    pool, listening = Pool(2), socket.create_server(("127.0.0.1", 0))
    host = f"127.0.0.1:{listening.getsockname()[1]}"
    server = running(application((host,), pool, start={"name": "helical_pitting", "pair": "pinion_wheel", "case": ""}))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    yield f"http://{host}/"
    server.should_exit = True
    thread.join()
    listening.close()


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("chromium")) as made:
        yield made


@pytest.fixture
def page(browser, place):
    session = browser.page(f"{place}#z_1=22")
    browser.until(session, READY)
    yield session
    own = [one for one in browser.asked if not one.startswith((place, "data:", "blob:", "about:"))]
    assert own == []
    assert browser.errors == []


def test_numbers_and_pictures_are_those_of_gearfe(browser, page):
    wanted = json.loads(answer("fine", checked_state(START | {"z_1": 22})))
    assert browser.run(page, "$('headline').textContent") == wanted["headline"]
    cells = "[...$('zones').rows].map((row) => [...row.cells].map((one) => one.textContent))"
    assert browser.run(page, cells) == wanted["tables"][0][1]
    drawn = browser.run(page, "$('curves').data.filter((one) => one.name === 'cracked' && !one.yaxis)[0].y")
    assert drawn == wanted["curves"][1]["k"]
    assert browser.run(page, "document.querySelectorAll('#mesh [data-gear]').length") == 2
    assert "crack (tooth 0) in the pinion" in browser.run(page, "$('mesh').getAttribute('aria-label')")


def test_a_change_is_solved_pinned_undone_and_linked(browser, page, place):
    before = browser.run(page, "$('headline').textContent")
    browser.run(page, "$('pin').click()")
    slider = "$('damage_0_length_mm_slider').value = 3; $('damage_0_length_mm_slider').dispatchEvent(new Event('input')); 1"
    browser.run(page, slider)
    assert browser.run(page, "document.body.classList.contains('dim') && $('curves').data.length > 0"), "dimmed, not blank"
    browser.until(page, READY)
    assert browser.run(page, "$('headline').textContent").startswith("3 mm crack")
    assert browser.run(page, "$('curves').data.some((one) => one.name === 'pinned, cracked')")
    browser.until(page, "location.hash.includes('length_mm%22%3A3')")
    other = browser.page(browser.run(page, "location.href"))
    browser.until(other, READY)
    assert browser.run(other, "$('headline').textContent") == browser.run(page, "$('headline').textContent")
    browser.run(page, "$('undo').click()")
    browser.until(page, f"{READY} && $('headline').textContent === {json.dumps(before)}")


def test_a_crack_grows_by_its_slider(browser, page):
    browser.run(page, "$('crack_grown_slider').value = 0.4; $('crack_grown_slider').dispatchEvent(new Event('input')); 1")
    browser.until(page, f"{READY} && $('headline').textContent.includes('crack along a path')")
    wanted = json.loads(answer("fine", checked_state(START | {"z_1": 22, "crack_grown": 0.4})))
    assert browser.run(page, "$('headline').textContent") == wanted["headline"]


def test_damage_is_added_changed_and_removed(browser, page):
    """Of both gears; an empty field is a key that is left out, and a level takes the place of a length."""

    def enter(name, text):
        code = f"$({name!r}).value = {text!r}; $({name!r}).dispatchEvent(new Event('input')); JSON.stringify(state.damage)"
        return json.loads(browser.run(page, code))

    browser.run(page, "$('add').value = 'missing_tooth'; $('add').dispatchEvent(new Event('change')); 1")
    assert enter("damage_1_tooth", "7")[1] == {"kind": "missing_tooth", "gear": "pinion", "tooth": 7}
    assert enter("damage_1_gear", "wheel")[1]["gear"] == "wheel"
    first = {"kind": "crack", "gear": "pinion", "angle_deg": 60}
    assert enter("damage_0_level", "0.3")[0] == first | {"level": 0.3}
    assert enter("damage_0_width_mm", "0, 8")[0] == first | {"level": 0.3, "width_mm": [0, 8]}
    assert enter("damage_0_width_mm", "")[0] == first | {"level": 0.3}
    assert enter("damage_0_turning", "yes")[0] == first | {"level": 0.3, "turning": True}
    browser.until(page, READY)
    wanted = [first | {"level": 0.3, "turning": True}, {"kind": "missing_tooth", "gear": "wheel", "tooth": 7}]
    answered = json.loads(answer("fine", checked_state(START | {"z_1": 22, "damage": wanted})))
    assert browser.run(page, "$('headline').textContent") == answered["headline"]
    titles = "all('#zones th').filter((one) => one.colSpan > 1).map((one) => one.textContent)"
    assert browser.run(page, titles) == [words for words, _ in answered["tables"]]
    for _ in range(2):
        browser.run(page, "$('remove_0').click(); 1")
    browser.until(page, f"{READY} && $('headline').textContent.startsWith('healthy')")
    assert browser.run(page, "all('#damage details').length") == 0


def test_a_refusal_is_told_and_the_picture_stays(browser, page):
    browser.run(page, "change(fields.find((one) => one.name === 'held_1'), 30); 1")
    browser.until(page, "$('said').classList.contains('refused')")
    assert "the bore must lie inside the root circle" in browser.run(page, "$('said').textContent")
    assert browser.run(page, "$('curves').data.length > 0 && $('headline').textContent.length > 10")
    browser.run(page, "$('held_1').value = ''; $('held_1').dispatchEvent(new Event('input')); 1")
    browser.until(page, "$('said').textContent.includes('the field is empty')")


def test_the_program_and_the_bands_follow_the_gears(browser, page):
    browser.run(page, "document.querySelector('[data-file=python]').click()")
    browser.until(page, "$('program').textContent.includes('gf.Gear(z=22')")
    browser.run(page, "change(fields.find((one) => one.name === 'z_1'), 25); 1")
    browser.until(page, "$('program').textContent.includes('gf.Gear(z=25')")
    share = browser.run(page, "shown.share")
    fewest = [sum(bool(one[i]) for one in share["value"]) == 1 for i in range(len(share["phase"]))]
    shaded = browser.run(page, "$('curves').layout.shapes.map((one) => [one.x0, one.x1])")
    inside = [any(low < phase < high or phase in (low, high) for low, high in shaded) for phase in share["phase"]]
    assert inside == fewest


def test_helical_teeth_get_their_own_result_without_being_asked(browser, place):
    session = browser.page(f"{place}#beta=15.0")
    browser.until(session, READY)
    assert browser.run(session, "$('headline').textContent").startswith("Transverse section alone: ")
    browser.until(session, "shown.method.includes('ritz3d') && !document.body.classList.contains('dim')", 60.0)
    wanted = json.loads(answer("solid", checked_state(START | {"beta": 15.0})))["headline"]
    assert browser.run(session, "$('headline').textContent") == wanted


def test_every_control_has_a_name_and_the_phone_no_wider_page(browser, place):
    session = browser.page(place, width=390, height=844, touch=True)
    browser.until(session, READY)
    assert browser.run(session, "document.documentElement.scrollWidth") <= 390
    assert browser.run(session, "document.querySelector('.wide').scrollWidth <= document.querySelector('.wide').clientWidth")
    assert browser.run(session, "state.z_2") == 60, "the scene that the command named"
    nameless = "all('input, select, button, summary').filter((one) => !(one.ariaLabel || one.labels?.length || one.textContent))"
    assert browser.run(session, f"{nameless}.map((one) => one.id)") == []


def test_a_server_that_is_gone_is_told(browser, page):
    browser("Network.emulateNetworkConditions", page, offline=True, latency=0, downloadThroughput=-1, uploadThroughput=-1)
    browser.run(page, "change(fields.find((one) => one.name === 'force'), 900); 1")
    browser.until(page, "$('said').textContent.includes('does not answer')")
    browser.errors.clear()
