// What the service sends and takes, by the names that the pages use. `openapi_types.d.ts` is made of its OpenAPI
// document (`make pages`). Types only: no browser ever loads this file.
// Times are ISO 8601 in UTC, lengths are metres, charge is a ratio of 0 to 1.

import type { components } from "./openapi_types.d.ts";

type Schemas = components["schemas"];

export type About = Schemas["About"];
export type Person = Schemas["PersonView"];
/** The signed-in person. */
export type Me = Schemas["MyView"];
export type Party = Schemas["PartyView"];

export type CampusMap = Schemas["MapView"];
export type MapPost = Schemas["PostView"];
export type MapCorridor = Schemas["CorridorView"];
export type Traffic = Schemas["Traffic"];
export type OccupiedCorridor = Schemas["OccupiedCorridor"];
/** The bay, crossing or corridor that a robot reports to be in. */
export type ReportedPlace = Schemas["ReportedPlace"];
/** The corridors that this robot holds now, and where it reports to be. */
export type RobotTraffic = Schemas["RobotTraffic"];

/** The closed corridors. */
export type ClosedCorridors = Schemas["ClosedCorridors"];
export type ClosedCorridor = Schemas["ClosedCorridorView"];

export type ArrivalWindow = Schemas["WindowView"];
export type Estimate = Schemas["Estimate"];
export type Robot = Schemas["RobotView"];
export type Expected = Schemas["Expected"];
export type WaitsFor = NonNullable<Robot["waits_for"]>;
/** A sentence as a text of the catalogue and what fills its gaps. */
export type Words = Schemas["Words"];

export type Order = Schemas["OrderView"];
export type OrderState = Order["state"];
export type OrderEvent = Schemas["EventView"];
export type Role = Order["my_role"];
export type Purpose = NonNullable<Order["my_code"]>;
export type WantedOrder = Required<Pick<Schemas["NewOrder"], "from_post" | "to_post" | "recipient">> & {
  description: string;
  not_before?: string;
};
export type NewStandingOrder = Omit<WantedOrder, "not_before"> & Pick<Schemas["NewStandingOrder"], "weekdays" | "at" | "zone" | "until">;
export type StandingOrder = Schemas["StandingOrderView"];
export type Custody = Schemas["CustodyView"];

export type HandoverCode = Schemas["CodeView"];
export type LinkedCode = Schemas["LinkedCode"];
/** A code and the address of its picture. */
export type ShownCode = Omit<HandoverCode, "svg_url"> & { picture: string };
export type Delegate = Schemas["DelegateView"];
export type MyDelegate = Schemas["MyDelegateView"];
export interface NewDelegate { name: string; email?: string }

export type AboutMe = Schemas["AboutMe"];
export type Contact = Schemas["ContactView"];
export type NotificationPreferences = Schemas["PreferencesView"];
export type NewWebhook = Schemas["NewWebhookView"];
export type Trial = Schemas["TrialView"];
export type OpenSession = Schemas["SessionView"];
export type Token = Schemas["TokenView"];
export type NewToken = Schemas["TokenRequest"];
export type MadeToken = Schemas["NewTokenView"];

/** An order that a dispatcher places for a visitor at their desk. */
export type WalkUpOrder = WantedOrder & { on_behalf_of: string; priority: Order["priority"] };
export type Alarm = Schemas["AlarmView"];
export type Command = Schemas["CommandView"];
export type RobotDetails = Schemas["RobotDetails"];
export type BatteryHistory = Schemas["BatteryHistory"];
export type EstimateQuality = Schemas["EstimateQuality"];
export type EnrolmentCode = Schemas["EnrolmentCodeView"];
export type RobotToken = Schemas["RobotTokenView"];
export type Watch = Schemas["WatchView"];
/** A sent object always has all its fields, those with a default too. */
type Told<T> = T extends (infer Item)[] ? Told<Item>[] : T extends object ? { [K in keyof T]-?: Told<T[K]> } : T;
export type Watched = Told<Schemas["Watched"]>;
export type Diagnostics = Watched["insight"];
export type Sensors = Diagnostics["sensors"];
export type IntentionView = Diagnostics["intentions"][number];
export type Because = IntentionView["because"];
export type Means = IntentionView["stack"][number];
export type NotChosen = Means["passed_over"][number];
export type TraceLine = Diagnostics["trace"][number];
export type Sending = Schemas["DeliveryView"];
export type SpooledMail = Schemas["SpooledMail"];
export type SpooledText = Schemas["SpooledText"];

export type NotificationView = Schemas["NotificationView"];
export type Inbox = Schemas["Inbox"];
export interface Page<Item> { items: Item[]; next: string | null }
