# The public names as a type checker reads them; at run time gearfe/__init__.py loads each on first use.

from geometry.damage.crack import Crack as Crack
from geometry.damage.pit import Pit as Pit
from geometry.pair.gear_pair import GearPair as GearPair
from geometry.pair.planetary import PlanetarySet as PlanetarySet
from geometry.tooth.gear import Gear as Gear

from .elements.contact_deck import write_contact_inp as write_contact_inp
from .elements.deck import write_inp as write_inp
from .elements.fracture import stress_intensity as stress_intensity
from .elements.loaded_tooth import root_stress as root_stress
from .elements.loaded_tooth import tooth_flexibility as tooth_flexibility
from .machine.compound_planetary import compound_planetary as compound_planetary
from .machine.gear_mesh import GearMesh as GearMesh
from .machine.gear_mesh import Samples as Samples
from .machine.gear_mesh import ToothDamage as ToothDamage
from .machine.gear_pair import gear_pair as gear_pair
from .machine.helical_pair import pitted_helical as pitted_helical
from .machine.herringbone_planetary import herringbone_planetary as herringbone_planetary
from .machine.layout import Body as Body
from .machine.layout import Layout as Layout
from .machine.member import Member as Member
from .machine.member import disc as disc
from .machine.mesh_errors import with_errors as with_errors
from .machine.of_scene import build_machine as build_machine
from .machine.pitted_planetary import pitted_planetary as pitted_planetary
from .machine.planetary import planetary as planetary
from .machine.planetary import stage_phases as stage_phases
from .machine.single_mesh import single_mesh as single_mesh
from .machine.tables import Load as Load
from .machine.tables import Machine as Machine
from .machine.tables import Spring as Spring
from .machine.tables import Stage as Stage
from .machine.tables import natural_frequencies as natural_frequencies
from .machine.tables import pulses as pulses
from .material import Material as Material
from .motion.portrait import phase_portrait as phase_portrait
from .motion.portrait import poincare_section as poincare_section
from .motion.response import Response as Response
from .motion.simulate import simulate as simulate
from .motion.steady import steady_state as steady_state
from .pictures.stiffness_plots import plot_contact as plot_contact
from .pictures.vibration_plots import plot_kurtogram as plot_kurtogram
from .pictures.vibration_plots import plot_phase as plot_phase
from .pictures.vibration_plots import plot_spectra as plot_spectra
from .reports.page import report as report
from .scene.load import load_scene as load_scene
from .signal.demodulation import demodulate as demodulate
from .signal.housing import housing_signal as housing_signal
from .signal.indicators import indicator_table as indicator_table
from .signal.kurtogram import fast_kurtogram as fast_kurtogram
from .signal.kurtogram import spectral_kurtosis as spectral_kurtosis
from .signal.orders import order_spectrum as order_spectrum
from .signal.orders import residual_signal as residual_signal
from .signal.orders import synchronous_average as synchronous_average
from .signal.series import Signal as Signal
from .signal.series import envelope as envelope
from .signal.series import integrate as integrate
from .signal.signal_file import read_signal as read_signal
from .signal.spectra import power_spectral_density as power_spectral_density
from .signal.spectra import spectrum as spectrum
from .signal.spectra import squared_envelope_spectrum as squared_envelope_spectrum
from .signal.spectral_lines import expected_lines as expected_lines
from .signal.spectral_lines import find_lines as find_lines
from .stiffness.curve import StiffnessCurve as StiffnessCurve
from .stiffness.own_flexibility import OwnFlexibility as OwnFlexibility
from .stiffness.solve import mesh_stiffness as mesh_stiffness
from .stress.render import render_stress as render_stress
from .studies.batches import batch as batch
from .studies.by_zone import compare as compare
from .studies.errormap import error_map as error_map
from .studies.model_file import read_model as read_model
from .studies.own_model import PairModel as PairModel

__all__: list[str]

def __dir__() -> list[str]: ...

from .scene.new import new_scene as new_scene
