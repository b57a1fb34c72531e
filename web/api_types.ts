// What the service sends and takes, field by field. Types only: no browser ever loads this file.
// Times are ISO 8601 in UTC, lengths are metres, charge is a ratio of 0 to 1.

export type OrderState =
  | "queued" | "assigned" | "to_sender" | "at_sender" | "carrying" | "at_recipient" | "delivered"
  | "returning" | "at_return" | "returned" | "held"
  | "expired" | "cancelled" | "attention";

export type Role = "sender" | "recipient" | "dispatcher" | "delegate";
export type Purpose = "load" | "receive" | "return";

export interface Person { id: string; email: string; name: string; language: string; roles: string[] }
export interface Party { email: string; name: string }

export interface About {
  name: string;
  version: string;
  simulated: boolean;
  demo: boolean;
  now: string;
  languages: string[];
  allowed_domains: string[];
  campus_sign_in: boolean;
  map: string;
}

export interface MapPost { name: string; title: string; x_m: number; y_m: number; dock: unknown; mailroom: boolean }
export interface MapCorridor {
  name: string;
  a: string;
  b: string;
  length_m: number;
  assumed: boolean;
  tape: [number, number][];
}
export interface CampusMap {
  name: string;
  title: string;
  version: string;
  note: string;
  posts: MapPost[];
  corridors: MapCorridor[];
}

export interface ArrivalWindow { from: string; to: string; assumed?: boolean }
export interface Estimate { window: ArrivalWindow; length_m: number; assumed: boolean }

/** A sentence as a text of the catalogue and what fills its gaps. */
export interface Words { key: string; facts: Record<string, string> }

export interface Robot {
  name: string;
  online: boolean;
  last_seen: { post: string; previous: string | null; at: string } | null;
  towards: string | null;
  expected: { post: string; from: string; to: string } | null;
  activity: string;
  battery: { ratio: number; charging: boolean } | null;
  why: string | null;
  why_words: Words | null;
  heard_at: string | null;
}

export interface OrderEvent {
  seq: number;
  /** "moved" for a change of state; any other says what else happened. */
  kind: string;
  state: OrderState;
  at: string;
  robot_at: string | null;
  by: string;
  robot: string | null;
  post: string | null;
  reason: string | null;
  reason_words: Words | null;
}

export interface Order {
  id: string;
  state: OrderState;
  version: number;
  from_post: string;
  to_post: string;
  sender: Party;
  recipient: Party;
  description: string | null;
  created_at: string;
  updated_at: string;
  window: ArrivalWindow | null;
  robot: Robot | null;
  why: string | null;
  why_words: Words | null;
  my_role: Role;
  my_code: Purpose | null;
  /** Somebody has tapped, and the robot has not answered yet. */
  handover_requested: { how: string; at: string; expires_at: string } | null;
  can_cancel: boolean;
  /** Asked for, and not yet answered by the robot. */
  cancel_requested: boolean;
  /** The mail is aboard and is to be brought back; the robot has not answered yet. */
  return_requested: boolean;
  events: OrderEvent[];
}

export interface WantedOrder { from_post: string; to_post: string; recipient: string; description: string }
export interface HandoverCode {
  purpose: Purpose;
  text: string;
  digits: string;
  digits_locked: boolean;
  svg_url: string;
  expires_at: string | null;
}
/** A code and the address of its picture. */
export interface ShownCode extends HandoverCode { picture: string }
export interface Notice {
  id: number;
  /** An alarm of a robot has none. */
  order_id: string | null;
  kind: string;
  title: string;
  body: string;
  at: string;
  read: boolean;
}
export interface Page<Item> { items: Item[]; next: string | null }
export interface Inbox extends Page<Notice> { unread: number }
