// What we use of a service worker's own world. TypeScript's `webworker` cannot stand beside `dom` in one program.

interface LaterEvent extends Event {
  waitUntil(work: Promise<unknown>): void;
}

interface FetchedEvent extends LaterEvent {
  readonly request: Request;
  readonly clientId: string;
  respondWith(answer: Promise<Response>): void;
}

interface ToldEvent extends LaterEvent {
  readonly data: unknown;
}

interface PushedEvent extends LaterEvent {
  readonly data: { text(): string } | null;
}

interface ChosenEvent extends LaterEvent {
  readonly notification: Notification;
}

interface SyncedEvent extends LaterEvent {
  readonly tag: string;
}

interface OpenPage {
  readonly id: string;
  readonly url: string;
  focus(): Promise<OpenPage>;
  navigate(url: string): Promise<OpenPage | null>;
}

interface WorkerEvents {
  install: LaterEvent;
  activate: LaterEvent;
  fetch: FetchedEvent;
  message: ToldEvent;
  push: PushedEvent;
  notificationclick: ChosenEvent;
  pushsubscriptionchange: LaterEvent;
  sync: SyncedEvent;
}

interface WorkerScope {
  readonly registration: ServiceWorkerRegistration;
  readonly clients: {
    claim(): Promise<void>;
    matchAll(options?: { type?: "window"; includeUncontrolled?: boolean }): Promise<OpenPage[]>;
    openWindow(url: string): Promise<OpenPage | null>;
  };
  skipWaiting(): Promise<void>;
  addEventListener<K extends keyof WorkerEvents>(kind: K, listener: (event: WorkerEvents[K]) => void): void;
}

// Background Sync, where a browser has it.
interface ServiceWorkerRegistration {
  readonly sync?: { register(tag: string): Promise<void> };
}
