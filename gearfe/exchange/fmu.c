/* Gear pair by gearfe as an FMU 2.0, for model exchange and co-simulation. The first lines of this file, written by gearfe, define
   GUID, ROWS, CYCLES (mesh cycles of the tables), Z_1, R_1, R_2 (base radii in m), BACKLASH, and the tables PHASE (mesh cycles,
   rising from 0), K (N/m) and E (m).

   delta = R_1 phi_1 - R_2 phi_2 is the approach along the line of action. The drive flanks carry k (delta - e) while that is
   positive, the back flanks -k (e - backlash - delta). A damper c acts while flanks touch. Values between rows are linear. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef void* Component; typedef double Real; typedef int Integer; typedef int Boolean; typedef const char* String;
typedef unsigned int Ref; typedef int Status;
typedef struct { Boolean changed, terminate, nominals, values, timed; Real next; } Event;
enum { PHI_1, PHI_2, W_1, W_2, DAMPING, PLAY, TAU_1, TAU_2, FORCE, STIFFNESS, DEFLECTION, COUNT };
typedef struct { Real v[COUNT]; } Pair;
#define OK 0
#define BAD 3
#define EXPORT __attribute__((visibility("default")))
#ifdef _WIN32
#undef EXPORT
#define EXPORT __declspec(dllexport)
#endif

static void update(Pair* p) {
  Real* v = p->v;
  Real at = fmod(v[PHI_1] * Z_1 / 6.283185307179586476925, (Real)CYCLES);
  if (at < 0) at += CYCLES;
  int i = 0, end = ROWS;
  while (end - i > 1) { int middle = (i + end) / 2; if (PHASE[middle] <= at) i = middle; else end = middle; }
  int j = (i + 1) % ROWS;
  Real part = (at - PHASE[i]) / ((j ? PHASE[j] : CYCLES) - PHASE[i]);
  Real k = K[i] + part * (K[j] - K[i]), e = E[i] + part * (E[j] - E[i]);
  Real x = R_1 * v[PHI_1] - R_2 * v[PHI_2] - e;
  Real pressed = x > 0 ? x : (v[PLAY] > 0 && x < -v[PLAY] ? x + v[PLAY] : 0);
  if (v[PLAY] == 0) pressed = x;
  Real force = k * pressed + (pressed != 0 ? v[DAMPING] * (R_1 * v[W_1] - R_2 * v[W_2]) : 0);
  v[STIFFNESS] = k; v[DEFLECTION] = x + e; v[FORCE] = force; v[TAU_1] = -force * R_1; v[TAU_2] = force * R_2;
}

EXPORT const char* fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char* fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2SetDebugLogging(Component c, Boolean on, size_t n, const String s[]) { return OK; }
EXPORT Component fmi2Instantiate(String name, int type, String guid, String where, const void* functions, Boolean visible, Boolean log) {
  if (strcmp(guid, GUID)) return NULL;
  Pair* p = calloc(1, sizeof(Pair));
  if (p) { p->v[PLAY] = BACKLASH; update(p); }
  return p;
}
EXPORT void fmi2FreeInstance(Component c) { free(c); }
EXPORT Status fmi2SetupExperiment(Component c, Boolean t, Real tolerance, Real start, Boolean s, Real stop) { return OK; }
EXPORT Status fmi2EnterInitializationMode(Component c) { return OK; }
EXPORT Status fmi2ExitInitializationMode(Component c) { return OK; }
EXPORT Status fmi2Terminate(Component c) { return OK; }
EXPORT Status fmi2Reset(Component c) { memset(c, 0, sizeof(Pair)); ((Pair*)c)->v[PLAY] = BACKLASH; return OK; }
EXPORT Status fmi2SetReal(Component c, const Ref r[], size_t n, const Real value[]) {
  for (size_t i = 0; i < n; i++) { if (r[i] >= TAU_1) return BAD; ((Pair*)c)->v[r[i]] = value[i]; }
  return OK;
}
EXPORT Status fmi2GetReal(Component c, const Ref r[], size_t n, Real value[]) {
  update(c);
  for (size_t i = 0; i < n; i++) { if (r[i] >= COUNT) return BAD; value[i] = ((Pair*)c)->v[r[i]]; }
  return OK;
}
#define NONE(kind) \
  EXPORT Status fmi2Get##kind(Component c, const Ref r[], size_t n, kind value[]) { return n ? BAD : OK; } \
  EXPORT Status fmi2Set##kind(Component c, const Ref r[], size_t n, const kind value[]) { return n ? BAD : OK; }
NONE(Integer) NONE(Boolean) NONE(String)
EXPORT Status fmi2GetFMUstate(Component c, Component* s) {
  if (!*s) *s = malloc(sizeof(Pair));
  if (!*s) return BAD;
  memcpy(*s, c, sizeof(Pair));
  return OK;
}
EXPORT Status fmi2SetFMUstate(Component c, Component s) { memcpy(c, s, sizeof(Pair)); return OK; }
EXPORT Status fmi2FreeFMUstate(Component c, Component* s) { free(*s); *s = NULL; return OK; }
EXPORT Status fmi2SerializedFMUstateSize(Component c, Component s, size_t* n) { return BAD; }
EXPORT Status fmi2SerializeFMUstate(Component c, Component s, char b[], size_t n) { return BAD; }
EXPORT Status fmi2DeSerializeFMUstate(Component c, const char b[], size_t n, Component* s) { return BAD; }
EXPORT Status fmi2GetDirectionalDerivative(Component c, const Ref u[], size_t n, const Ref k[], size_t m, const Real d[], Real v[]) { return BAD; }
EXPORT Status fmi2EnterEventMode(Component c) { return OK; }
EXPORT Status fmi2NewDiscreteStates(Component c, Event* event) { memset(event, 0, sizeof(Event)); return OK; }
EXPORT Status fmi2EnterContinuousTimeMode(Component c) { return OK; }
EXPORT Status fmi2CompletedIntegratorStep(Component c, Boolean keep, Boolean* enter, Boolean* stop) { *enter = *stop = 0; return OK; }
EXPORT Status fmi2SetTime(Component c, Real t) { return OK; }
EXPORT Status fmi2SetContinuousStates(Component c, const Real x[], size_t n) { return n ? BAD : OK; }
EXPORT Status fmi2GetDerivatives(Component c, Real x[], size_t n) { return n ? BAD : OK; }
EXPORT Status fmi2GetEventIndicators(Component c, Real x[], size_t n) { return n ? BAD : OK; }
EXPORT Status fmi2GetContinuousStates(Component c, Real x[], size_t n) { return n ? BAD : OK; }
EXPORT Status fmi2GetNominalsOfContinuousStates(Component c, Real x[], size_t n) { return n ? BAD : OK; }
EXPORT Status fmi2SetRealInputDerivatives(Component c, const Ref r[], size_t n, const Integer o[], const Real v[]) { return BAD; }
EXPORT Status fmi2GetRealOutputDerivatives(Component c, const Ref r[], size_t n, const Integer o[], Real v[]) { return BAD; }
EXPORT Status fmi2DoStep(Component c, Real t, Real h, Boolean keep) { return OK; }
EXPORT Status fmi2CancelStep(Component c) { return BAD; }
EXPORT Status fmi2GetStatus(Component c, int s, Status* v) { return BAD; }
EXPORT Status fmi2GetRealStatus(Component c, int s, Real* v) { return BAD; }
EXPORT Status fmi2GetIntegerStatus(Component c, int s, Integer* v) { return BAD; }
EXPORT Status fmi2GetBooleanStatus(Component c, int s, Boolean* v) { return BAD; }
EXPORT Status fmi2GetStringStatus(Component c, int s, String* v) { return BAD; }
